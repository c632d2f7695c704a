// The natives of Java without Java: any buffers that its classes may pass, through functions that
// stand in for those of the virtual machine. No array or buffer is read or written beyond its end.
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <memory>
#include <vector>

#include "jni_shim/src/natives.cc"  // which exports only what registers them
#include "test/fuzz/call_bytes.h"

namespace lodemark_jni {
namespace {

using lodemark::test::Bytes;
using lodemark::test::Disturb;
using lodemark::test::Require;
using lodemark::test::Sized;

// What a reference of Java refers to: the memory of a direct buffer or an array.
struct Memory {
  std::vector<std::uint8_t> bytes;
};

Memory& Of(jobject object) { return *reinterpret_cast<Memory*>(object); }
template <typename Reference = jobject>
Reference To(Memory* memory) {
  return reinterpret_cast<Reference>(memory);
}

template <typename T>
void Get(jobject array, jsize start, jsize count, T* out) {
  Require(start == 0 && static_cast<std::size_t>(count) * sizeof(T) <= Of(array).bytes.size());
  if (count > 0)
    std::memcpy(out, Of(array).bytes.data(), static_cast<std::size_t>(count) * sizeof(T));
}
template <typename T>
void Set(jobject array, jsize start, jsize count, const T* values) {
  Require(start == 0 && static_cast<std::size_t>(count) * sizeof(T) <= Of(array).bytes.size());
  if (count > 0) {
    std::memcpy(Of(array).bytes.data(), values, static_cast<std::size_t>(count) * sizeof(T));
  }
}

// Of the latest native; in Java the collector frees it.
std::unique_ptr<Memory> made;

JNINativeInterface_ Functions() {
  JNINativeInterface_ functions = {};
  functions.GetDirectBufferCapacity = [](JNIEnv*, jobject buffer) {
    return static_cast<jlong>(Of(buffer).bytes.size());
  };
  functions.GetDirectBufferAddress = [](JNIEnv*, jobject buffer) -> void* {
    return Of(buffer).bytes.data();
  };
  functions.GetArrayLength = [](JNIEnv*, jarray array) {
    return static_cast<jsize>(Of(array).bytes.size());
  };
  functions.NewByteArray = [](JNIEnv*, jsize length) {
    made = std::make_unique<Memory>();
    made->bytes.resize(static_cast<std::size_t>(length));
    return To<jbyteArray>(made.get());
  };
  functions.GetByteArrayRegion = [](JNIEnv*, jbyteArray array, jsize start, jsize count,
                                    jbyte* out) { Get(array, start, count, out); };
  functions.SetByteArrayRegion = [](JNIEnv*, jbyteArray array, jsize start, jsize count,
                                    const jbyte* values) { Set(array, start, count, values); };
  functions.GetDoubleArrayRegion = [](JNIEnv*, jdoubleArray array, jsize start, jsize count,
                                      jdouble* out) { Get(array, start, count, out); };
  functions.SetDoubleArrayRegion = [](JNIEnv*, jdoubleArray array, jsize start, jsize count,
                                      const jdouble* values) { Set(array, start, count, values); };
  functions.SetLongArrayRegion = [](JNIEnv*, jlongArray array, jsize start, jsize count,
                                    const jlong* values) { Set(array, start, count, values); };
  functions.SetIntArrayRegion = [](JNIEnv*, jintArray array, jsize start, jsize count,
                                   const jint* values) { Set(array, start, count, values); };
  return functions;
}

class Sequence {
 public:
  explicit Sequence(Bytes bytes) : bytes_(bytes) { env_.functions = &functions_; }
  ~Sequence() {
    SessionClose(&env_, nullptr, session_);
    UndistortionClose(&env_, nullptr, undistortion_);
  }

  void Run() {
    for (int calls = 0; calls < 100 && !bytes_.empty(); ++calls) Step(bytes_.Take<std::uint8_t>());
  }

 private:
  void Step(std::uint8_t call) {
    switch (call % 14) {
      case 0:
        SessionClose(&env_, nullptr, session_);
        session_ = Handle([&](jlongArray out) {
          return SessionOpen(&env_, nullptr, Structs<lodemark_session_options>(1), out);
        });
        return;
      case 1: {
        const auto count = Count();
        SessionPushGnss(&env_, nullptr, session_, bytes_.Take<std::int64_t>(),
                        Structs<lodemark_gnss_clock>(1), Structs<lodemark_gnss_measurement>(count),
                        Told(count));
        return;
      }
      case 2: {
        const jobject content = Raw(bytes_.Take<std::uint16_t>() % 1024u);
        SessionPushNavigation(&env_, nullptr, session_, Text(), content, Size(content),
                              Structs<lodemark_read_report>(1));
        return;
      }
      case 3: {
        const jobject content = Raw(bytes_.Take<std::uint16_t>() % 1024u);
        SessionPushPreciseOrbits(&env_, nullptr, session_, Text(), content, Size(content),
                                 Structs<lodemark_read_report>(1));
        return;
      }
      case 4: {
        const jobject message = Structs<lodemark_broadcast_message>(1);
        const jobject content = Raw(bytes_.Take<std::uint8_t>());
        SessionPushBroadcast(&env_, nullptr, session_, message, content,
                             static_cast<jint>(Size(content)));
        return;
      }
      case 5: {
        const auto count = Count();
        SessionPushSensors(&env_, nullptr, session_, Structs<lodemark_sensor_sample>(count),
                           Told(count));
        return;
      }
      case 6: {
        const Image image = TakeImage();
        SessionPushImage(&env_, nullptr, session_, Structs<lodemark_frame>(1), image.lens,
                         image.pixels, image.size, image.stride_bytes);
        return;
      }
      case 7:
        SessionProcess(&env_, nullptr, session_);
        return Read();
      case 8: {
        const auto count = Count();
        PositionSolve(&env_, nullptr, Structs<lodemark_range>(count), Told(count),
                      Structs<lodemark_solve_options>(1), Structs<lodemark_solution>(1),
                      Structs<lodemark_range_residual>(count));
        return;
      }
      case 9:
        return Convert();
      case 10:
        return Undistort();
      case 11: {
        const auto count = Count();
        PoseResect(&env_, nullptr, Lens(), Structs<lodemark_sight>(count), Told(count),
                   Structs<lodemark_view_prior>(1), Structs<lodemark_pose>(1),
                   Structs<lodemark_sight_residual>(count));
        return;
      }
      case 12: {
        const auto values = To<jdoubleArray>(Keep(3 * sizeof(double)));
        const auto origin = To<jdoubleArray>(Keep(3 * sizeof(double)));
        EcefFromGeodetic(&env_, nullptr, values);
        EnuFromEcef(&env_, nullptr, origin, values);
        GeodeticFromEcef(&env_, nullptr, values);
        EcefFromEnu(&env_, nullptr, origin, values);
        return;
      }
      default:
        Require(LastError(&env_, nullptr) != nullptr && LayoutOf(&env_, nullptr) != nullptr);
        StatusName(&env_, nullptr, bytes_.Take<std::int8_t>());
        return;
    }
  }

  void Read() {
    SessionEstimate(&env_, nullptr, session_, Structs<lodemark_estimate>(1));
    const auto count = Count();
    const auto total = To<jintArray>(Keep(sizeof(jint)));
    SessionList<lodemark_satellite, lodemark_session_satellites>(
        &env_, nullptr, session_, Structs<lodemark_satellite>(count), Told(count), total);
    SessionList<lodemark_landmark, lodemark_session_landmarks>(
        &env_, nullptr, session_, Structs<lodemark_landmark>(count), Told(count), total);
    SessionList<lodemark_event, lodemark_session_events>(
        &env_, nullptr, session_, Structs<lodemark_event>(count), Told(count), total);
  }

  void Convert() {
    const jobject lens = Lens();
    const auto count = Count();
    const jobject from = Raw(count * 3 * sizeof(double));
    const jobject to = Raw(count * 3 * sizeof(double));
    const jobject valid = Raw(count);
    const jint told = Told(count);
    LensConvert<lodemark_lens_unproject, 2, 3>(&env_, nullptr, lens, from, told, to, valid);
    LensConvert<lodemark_lens_project, 3, 2>(&env_, nullptr, lens, from, told, to, valid);
    LensConvert<lodemark_lens_undistort_points, 2, 2>(&env_, nullptr, lens, from, told, to, valid);
  }

  void Undistort() {
    UndistortionClose(&env_, nullptr, undistortion_);
    const Image image = TakeImage();
    const jobject used = Structs<lodemark_lens>(1, false);
    undistortion_ = Handle([&](jlongArray out) {
      return UndistortionOpen(&env_, nullptr, image.lens, nullptr, used, out);
    });
    if (undistortion_ == 0) return;
    lodemark_lens target = Sized<lodemark_lens>();
    std::memcpy(&target, Of(used).bytes.data(), sizeof target);
    const jlong size = ImageBytes(target, image.stride_bytes);
    UndistortionApply(&env_, nullptr, undistortion_, image.pixels, image.size, image.stride_bytes,
                      Raw(static_cast<std::size_t>(std::max<jlong>(0, size))), size,
                      image.stride_bytes);
  }

  struct Image {
    jobject lens = nullptr;
    jobject pixels = nullptr;
    jlong size = 0;
    jlong stride_bytes = 0;
  };

  // As io.lodemark.Lens works it out.
  static jlong ImageBytes(const lodemark_lens& lens, jlong stride_bytes) {
    return (std::max<jlong>(1, lens.height_px) - 1) * stride_bytes +
           std::max<jlong>(0, lens.width_px);
  }

  Image TakeImage() {
    Image image;
    image.lens = Lens();
    lodemark_lens lens = Sized<lodemark_lens>();
    std::memcpy(&lens, Of(image.lens).bytes.data(), sizeof lens);
    image.stride_bytes = 60 + bytes_.Take<std::uint8_t>();
    image.size = ImageBytes(lens, image.stride_bytes);
    const bool enough = image.size < 1'000'000 && bytes_.Take<std::uint8_t>() % 8 != 0;
    image.pixels = Raw(enough ? static_cast<std::size_t>(image.size) : 7);
    return image;
  }

  jobject Lens() {
    auto lens = Sized<lodemark_lens>();
    lens.model = bytes_.Take<std::uint8_t>() % 4;
    lens.width_px = 64;
    lens.height_px = 48;
    lens.fx_px = lens.fy_px = 50.0;
    lens.cx_px = 31.5;
    lens.cy_px = 23.5;
    Disturb(&bytes_, &lens);
    lens.struct_size = sizeof lens;  // Java has no other
    Memory* memory = Keep(sizeof lens);
    std::memcpy(memory->bytes.data(), &lens, sizeof lens);
    return To(memory);
  }

  // A buffer of structs that each state their size, of which some bytes are the input's, and which
  // may be too short, or none.
  template <typename T>
  jobject Structs(std::size_t count, bool disturbed = true) {
    const std::uint8_t how = disturbed ? bytes_.Take<std::uint8_t>() : std::uint8_t{255};
    if (how == 0) return nullptr;
    Memory* memory = Keep(std::max<std::size_t>(1, count) * sizeof(T), false);
    for (std::size_t i = 0; i < count; ++i) {
      auto value = Sized<T>();
      if (disturbed && i < 4) Disturb(&bytes_, &value);
      if (how < 16 && i == 0) value.struct_size = bytes_.Take<std::uint32_t>();
      std::memcpy(memory->bytes.data() + i * sizeof(T), &value, sizeof value);
    }
    if (how < 32) memory->bytes.resize(memory->bytes.size() * how / 32);
    memory->bytes.shrink_to_fit();
    return To(memory);
  }

  jobject Raw(std::size_t size) { return To(Keep(size)); }
  jlong Size(jobject buffer) {
    const std::uint8_t how = bytes_.Take<std::uint8_t>();
    return how == 0 ? bytes_.Take<std::int64_t>() : static_cast<jlong>(Of(buffer).bytes.size());
  }
  jbyteArray Text() {
    return bytes_.Take<std::uint8_t>() % 8 == 0 ? nullptr : To<jbyteArray>(Keep(5));
  }
  std::size_t Count() { return bytes_.Take<std::uint8_t>() % 24u; }
  // What the native is told, which may not be what there is.
  jint Told(std::size_t count) {
    return bytes_.Take<std::uint8_t>() == 0 ? bytes_.Take<std::int32_t>()
                                            : static_cast<jint>(count);
  }

  template <typename Open>
  jlong Handle(const Open& open) {
    Memory* out = Keep(sizeof(jlong), false);
    const jint status = open(To<jlongArray>(out));
    jlong handle = 0;
    std::memcpy(&handle, out->bytes.data(), sizeof handle);
    Require((handle != 0) == (status == LODEMARK_OK));
    return handle;
  }

  Memory* Keep(std::size_t size, bool filled = true) {
    if (memory_.size() > 64) memory_.erase(memory_.begin(), memory_.begin() + 32);
    memory_.push_back(std::make_unique<Memory>());
    std::vector<std::uint8_t>& bytes = memory_.back()->bytes;
    bytes.resize(size);
    for (std::size_t i = 0; filled && i < size && !bytes_.empty(); ++i) {
      bytes[i] = bytes_.Take<std::uint8_t>();
    }
    return memory_.back().get();
  }

  Bytes bytes_;
  JNINativeInterface_ functions_ = Functions();
  JNIEnv env_ = {};
  std::vector<std::unique_ptr<Memory>> memory_;
  jlong session_ = 0;
  jlong undistortion_ = 0;
};

}  // namespace
}  // namespace lodemark_jni

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  lodemark_jni::Sequence(lodemark::test::Bytes(data, size)).Run();
  return 0;
}
