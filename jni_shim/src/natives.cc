// The natives of io.lodemark.Native. Each translates its arguments and calls the one function of
// lodemark.h that it is named after; checks of values are made there, those of sizes in Java.
#include <jni.h>

#include "jni_shim/src/crossing.h"
#include "lodemark/lodemark.h"

namespace lodemark_jni {
namespace {

jbyteArray Version(JNIEnv* env, jclass) { return ToJava(env, lodemark_version()); }

jbyteArray StatusName(JNIEnv* env, jclass, jint status) {
  return ToJava(env, lodemark_status_name(status));
}

jbyteArray LastError(JNIEnv* env, jclass) { return ToJava(env, lodemark_last_error()); }

jbyteArray LayoutOf(JNIEnv* env, jclass) { return ToJava(env, LayoutText()); }

// Conversions of places. values and origin have three elements; the result replaces values.
template <typename Convert>
jint ConvertInPlace(JNIEnv* env, jdoubleArray values, const Convert& convert) {
  double place[3] = {};
  env->GetDoubleArrayRegion(values, 0, 3, place);
  const lodemark_status status = convert(place);
  if (status == LODEMARK_OK) env->SetDoubleArrayRegion(values, 0, 3, place);
  return status;
}

jint EcefFromGeodetic(JNIEnv* env, jclass, jdoubleArray values) {
  return ConvertInPlace(env, values,
                        [](double* place) { return lodemark_ecef_from_geodetic(place, place); });
}

jint GeodeticFromEcef(JNIEnv* env, jclass, jdoubleArray values) {
  return ConvertInPlace(env, values,
                        [](double* place) { return lodemark_geodetic_from_ecef(place, place); });
}

jint EnuFromEcef(JNIEnv* env, jclass, jdoubleArray origin_geodetic, jdoubleArray values) {
  double origin[3] = {};
  env->GetDoubleArrayRegion(origin_geodetic, 0, 3, origin);
  return ConvertInPlace(
      env, values, [&](double* place) { return lodemark_enu_from_ecef(origin, place, place); });
}

jint EcefFromEnu(JNIEnv* env, jclass, jdoubleArray origin_geodetic, jdoubleArray values) {
  double origin[3] = {};
  env->GetDoubleArrayRegion(origin_geodetic, 0, 3, origin);
  return ConvertInPlace(
      env, values, [&](double* place) { return lodemark_ecef_from_enu(origin, place, place); });
}

jint UnixFromGps(JNIEnv* env, jclass, jlong time_gps_ns, jlongArray out) {
  int64_t time_unix_ns = 0;
  const lodemark_status status = lodemark_unix_from_gps(time_gps_ns, &time_unix_ns);
  Put(env, out, time_unix_ns);
  return status;
}

jint GpsFromUnix(JNIEnv* env, jclass, jlong time_unix_ns, jlongArray out) {
  int64_t time_gps_ns = 0;
  const lodemark_status status = lodemark_gps_from_unix(time_unix_ns, &time_gps_ns);
  Put(env, out, time_gps_ns);
  return status;
}

jint PositionSolve(JNIEnv* env, jclass, jobject ranges, jint count, jobject options,
                   jobject solution, jobject residuals) {
  return lodemark_position_solve(Structs<lodemark_range>(env, ranges, count), count,
                                 Struct<lodemark_solve_options>(env, options),
                                 Struct<lodemark_solution>(env, solution),
                                 Structs<lodemark_range_residual>(env, residuals, count));
}

// The three conversions of points by a lens: from_values and to_values doubles for each.
template <lodemark_status (*kConvert)(const lodemark_lens*, const double*, int32_t, double*,
                                      uint8_t*),
          int kFromValues, int kToValues>
jint LensConvert(JNIEnv* env, jclass, jobject lens, jobject from, jint count, jobject to,
                 jobject valid) {
  const jlong points = count;
  const jlong size = static_cast<jlong>(sizeof(double));
  return kConvert(Struct<lodemark_lens>(env, lens),
                  static_cast<const double*>(Bytes(env, from, points * kFromValues * size)), count,
                  static_cast<double*>(Bytes(env, to, points * kToValues * size)),
                  static_cast<uint8_t*>(Bytes(env, valid, points)));
}

jint UndistortionOpen(JNIEnv* env, jclass, jobject lens, jobject target, jobject used_target,
                      jlongArray out) {
  lodemark_undistortion* undistortion = nullptr;
  const lodemark_status status = lodemark_undistortion_open(
      Struct<lodemark_lens>(env, lens), Struct<lodemark_lens>(env, target),
      Struct<lodemark_lens>(env, used_target), &undistortion);
  PutHandle(env, out, undistortion);
  return status;
}

void UndistortionClose(JNIEnv*, jclass, jlong undistortion) {
  lodemark_undistortion_close(Handle<lodemark_undistortion>(undistortion));
}

jint UndistortionApply(JNIEnv* env, jclass, jlong undistortion, jobject pixels, jlong size,
                       jlong stride_bytes, jobject out, jlong out_size, jlong out_stride_bytes) {
  return lodemark_undistortion_apply(Handle<lodemark_undistortion>(undistortion),
                                     static_cast<const uint8_t*>(Bytes(env, pixels, size)),
                                     stride_bytes, static_cast<uint8_t*>(Bytes(env, out, out_size)),
                                     out_stride_bytes);
}

jint PoseResect(JNIEnv* env, jclass, jobject lens, jobject sights, jint count, jobject prior,
                jobject pose, jobject residuals) {
  return lodemark_pose_resect(
      Struct<lodemark_lens>(env, lens), Structs<lodemark_sight>(env, sights, count), count,
      Struct<lodemark_view_prior>(env, prior), nullptr, Struct<lodemark_pose>(env, pose),
      Structs<lodemark_sight_residual>(env, residuals, count), nullptr);
}

jint MapOpen(JNIEnv* env, jclass, jbyteArray path, jlongArray out) {
  const Text text(env, path);
  lodemark_map* map = nullptr;
  const lodemark_status status = lodemark_map_open(text.get(), &map);
  PutHandle(env, out, map);
  return status;
}

void MapClose(JNIEnv*, jclass, jlong map) { lodemark_map_close(Handle<lodemark_map>(map)); }

jint MapReadInfo(JNIEnv* env, jclass, jlong map, jobject info) {
  return lodemark_map_read_info(Handle<lodemark_map>(map), Struct<lodemark_map_info>(env, info));
}

jint MapQuery(JNIEnv* env, jclass, jlong map, jobject lens, jobject pixels, jlong size,
              jlong stride_bytes, jobject prior, jobject out, jint capacity, jintArray total) {
  int32_t count = 0;
  const lodemark_status status =
      lodemark_map_query(Handle<lodemark_map>(map), Struct<lodemark_lens>(env, lens),
                         static_cast<const uint8_t*>(Bytes(env, pixels, size)), stride_bytes,
                         Struct<lodemark_view_prior>(env, prior), nullptr,
                         Structs<lodemark_sight>(env, out, capacity), capacity, &count);
  Put(env, total, count);
  return status;
}

jint MapLocate(JNIEnv* env, jclass, jlong map, jobject lens, jobject pixels, jlong size,
               jlong stride_bytes, jobject prior, jobject pose) {
  int32_t count = 0;
  return lodemark_map_locate(Handle<lodemark_map>(map), Struct<lodemark_lens>(env, lens),
                             static_cast<const uint8_t*>(Bytes(env, pixels, size)), stride_bytes,
                             Struct<lodemark_view_prior>(env, prior), nullptr, nullptr,
                             Struct<lodemark_pose>(env, pose), nullptr, nullptr, 0, &count);
}

jint SessionOpen(JNIEnv* env, jclass, jobject options, jlongArray out) {
  lodemark_session* session = nullptr;
  const lodemark_status status =
      lodemark_session_open(Struct<lodemark_session_options>(env, options), &session);
  PutHandle(env, out, session);
  return status;
}

void SessionClose(JNIEnv*, jclass, jlong session) {
  lodemark_session_close(Handle<lodemark_session>(session));
}

jint SessionReset(JNIEnv*, jclass, jlong session) {
  return lodemark_session_reset(Handle<lodemark_session>(session));
}

jint SessionPushGnss(JNIEnv* env, jclass, jlong session, jlong time_ns, jobject clock,
                     jobject measurements, jint count) {
  return lodemark_session_push_gnss(
      Handle<lodemark_session>(session), time_ns, Struct<lodemark_gnss_clock>(env, clock),
      Structs<lodemark_gnss_measurement>(env, measurements, count), count);
}

jint SessionPushNavigation(JNIEnv* env, jclass, jlong session, jbyteArray name, jobject bytes,
                           jlong size, jobject report) {
  const Text text(env, name);
  return lodemark_session_push_navigation(Handle<lodemark_session>(session), text.get(),
                                          Bytes(env, bytes, size), static_cast<size_t>(size),
                                          Struct<lodemark_read_report>(env, report));
}

jint SessionPushPreciseOrbits(JNIEnv* env, jclass, jlong session, jbyteArray name, jobject bytes,
                              jlong size, jobject report) {
  const Text text(env, name);
  return lodemark_session_push_precise_orbits(Handle<lodemark_session>(session), text.get(),
                                              Bytes(env, bytes, size), static_cast<size_t>(size),
                                              Struct<lodemark_read_report>(env, report));
}

jint SessionPushBroadcast(JNIEnv* env, jclass, jlong session, jobject message, jobject bytes,
                          jint size) {
  return lodemark_session_push_broadcast(
      Handle<lodemark_session>(session), Struct<lodemark_broadcast_message>(env, message),
      static_cast<const uint8_t*>(Bytes(env, bytes, size)), static_cast<size_t>(size));
}

jint SessionUseMap(JNIEnv*, jclass, jlong session, jlong map) {
  return lodemark_session_use_map(Handle<lodemark_session>(session), Handle<lodemark_map>(map));
}

jint SessionPushImage(JNIEnv* env, jclass, jlong session, jobject frame, jobject lens,
                      jobject pixels, jlong size, jlong stride_bytes) {
  return lodemark_session_push_image(
      Handle<lodemark_session>(session), Struct<lodemark_frame>(env, frame),
      Struct<lodemark_lens>(env, lens), static_cast<const uint8_t*>(Bytes(env, pixels, size)),
      stride_bytes);
}

jint SessionPushSensors(JNIEnv* env, jclass, jlong session, jobject samples, jint count) {
  return lodemark_session_push_sensors(Handle<lodemark_session>(session),
                                       Structs<lodemark_sensor_sample>(env, samples, count), count);
}

jint SessionProcess(JNIEnv*, jclass, jlong session) {
  return lodemark_session_process(Handle<lodemark_session>(session));
}

jint SessionQueued(JNIEnv* env, jclass, jlong session, jintArray out) {
  int32_t count = 0;
  const lodemark_status status = lodemark_session_queued(Handle<lodemark_session>(session), &count);
  Put(env, out, count);
  return status;
}

jint SessionEstimate(JNIEnv* env, jclass, jlong session, jobject estimate) {
  return lodemark_session_estimate(Handle<lodemark_session>(session),
                                   Struct<lodemark_estimate>(env, estimate));
}

// The lists: what the last process looked at, and what happened since the last clear.
template <typename T, lodemark_status (*kList)(const lodemark_session*, T*, int32_t, int32_t*)>
jint SessionList(JNIEnv* env, jclass, jlong session, jobject out, jint capacity, jintArray total) {
  int32_t count = 0;
  const lodemark_status status =
      kList(Handle<lodemark_session>(session), Structs<T>(env, out, capacity), capacity, &count);
  Put(env, total, count);
  return status;
}

jint SessionClearEvents(JNIEnv*, jclass, jlong session) {
  return lodemark_session_clear_events(Handle<lodemark_session>(session));
}

jint LogOpen(JNIEnv* env, jclass, jbyteArray path, jlongArray out) {
  const Text text(env, path);
  lodemark_log* log = nullptr;
  const lodemark_status status = lodemark_log_open(text.get(), &log);
  PutHandle(env, out, log);
  return status;
}

void LogClose(JNIEnv*, jclass, jlong log) { lodemark_log_close(Handle<lodemark_log>(log)); }

jint LogPushNext(JNIEnv*, jclass, jlong log, jlong session) {
  return lodemark_log_push_next(Handle<lodemark_log>(log), Handle<lodemark_session>(session));
}

template <typename Function>
constexpr JNINativeMethod Native(const char* name, const char* signature, Function* function) {
  return {const_cast<char*>(name), const_cast<char*>(signature), reinterpret_cast<void*>(function)};
}

#define BUFFER "Ljava/nio/ByteBuffer;"

bool Register(JNIEnv* env) {
  const JNINativeMethod natives[] = {
      Native("version", "()[B", Version),
      Native("statusName", "(I)[B", StatusName),
      Native("lastError", "()[B", LastError),
      Native("layout", "()[B", LayoutOf),
      Native("ecefFromGeodetic", "([D)I", EcefFromGeodetic),
      Native("geodeticFromEcef", "([D)I", GeodeticFromEcef),
      Native("enuFromEcef", "([D[D)I", EnuFromEcef),
      Native("ecefFromEnu", "([D[D)I", EcefFromEnu),
      Native("unixFromGps", "(J[J)I", UnixFromGps),
      Native("gpsFromUnix", "(J[J)I", GpsFromUnix),
      Native("positionSolve", "(" BUFFER "I" BUFFER BUFFER BUFFER ")I", PositionSolve),
      Native("lensUnproject", "(" BUFFER BUFFER "I" BUFFER BUFFER ")I",
             LensConvert<lodemark_lens_unproject, 2, 3>),
      Native("lensProject", "(" BUFFER BUFFER "I" BUFFER BUFFER ")I",
             LensConvert<lodemark_lens_project, 3, 2>),
      Native("lensUndistortPoints", "(" BUFFER BUFFER "I" BUFFER BUFFER ")I",
             LensConvert<lodemark_lens_undistort_points, 2, 2>),
      Native("undistortionOpen", "(" BUFFER BUFFER BUFFER "[J)I", UndistortionOpen),
      Native("undistortionClose", "(J)V", UndistortionClose),
      Native("undistortionApply", "(J" BUFFER "JJ" BUFFER "JJ)I", UndistortionApply),
      Native("poseResect", "(" BUFFER BUFFER "I" BUFFER BUFFER BUFFER ")I", PoseResect),
      Native("mapOpen", "([B[J)I", MapOpen),
      Native("mapClose", "(J)V", MapClose),
      Native("mapReadInfo", "(J" BUFFER ")I", MapReadInfo),
      Native("mapQuery", "(J" BUFFER BUFFER "JJ" BUFFER BUFFER "I[I)I", MapQuery),
      Native("mapLocate", "(J" BUFFER BUFFER "JJ" BUFFER BUFFER ")I", MapLocate),
      Native("sessionOpen", "(" BUFFER "[J)I", SessionOpen),
      Native("sessionClose", "(J)V", SessionClose),
      Native("sessionReset", "(J)I", SessionReset),
      Native("sessionPushGnss", "(JJ" BUFFER BUFFER "I)I", SessionPushGnss),
      Native("sessionPushNavigation", "(J[B" BUFFER "J" BUFFER ")I", SessionPushNavigation),
      Native("sessionPushPreciseOrbits", "(J[B" BUFFER "J" BUFFER ")I", SessionPushPreciseOrbits),
      Native("sessionPushBroadcast", "(J" BUFFER BUFFER "I)I", SessionPushBroadcast),
      Native("sessionUseMap", "(JJ)I", SessionUseMap),
      Native("sessionPushImage", "(J" BUFFER BUFFER BUFFER "JJ)I", SessionPushImage),
      Native("sessionPushSensors", "(J" BUFFER "I)I", SessionPushSensors),
      Native("sessionProcess", "(J)I", SessionProcess),
      Native("sessionQueued", "(J[I)I", SessionQueued),
      Native("sessionEstimate", "(J" BUFFER ")I", SessionEstimate),
      Native("sessionSmoothed", "(J" BUFFER "I[I)I",
             SessionList<lodemark_estimate, lodemark_session_smoothed>),
      Native("sessionSatellites", "(J" BUFFER "I[I)I",
             SessionList<lodemark_satellite, lodemark_session_satellites>),
      Native("sessionLandmarks", "(J" BUFFER "I[I)I",
             SessionList<lodemark_landmark, lodemark_session_landmarks>),
      Native("sessionEvents", "(J" BUFFER "I[I)I",
             SessionList<lodemark_event, lodemark_session_events>),
      Native("sessionClearEvents", "(J)I", SessionClearEvents),
      Native("logOpen", "([B[J)I", LogOpen),
      Native("logClose", "(J)V", LogClose),
      Native("logPushNext", "(JJ)I", LogPushNext),
  };
  jclass owner = env->FindClass("io/lodemark/Native");
  if (owner == nullptr) return false;
  const auto count = static_cast<jint>(sizeof natives / sizeof natives[0]);
  return env->RegisterNatives(owner, natives, count) == JNI_OK;
}

}  // namespace
}  // namespace lodemark_jni

extern "C" JNIEXPORT jint JNI_OnLoad(JavaVM* vm, void*) {
  void* env = nullptr;
  if (vm->GetEnv(&env, JNI_VERSION_1_6) != JNI_OK) return JNI_ERR;
  return lodemark_jni::Register(static_cast<JNIEnv*>(env)) ? JNI_VERSION_1_6 : JNI_ERR;
}
