// How values cross between Java and lodemark.h: handles, direct buffers, byte strings.
#pragma once

#include <jni.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "lodemark/lodemark.h"

namespace lodemark_jni {

template <typename T>
T* Handle(jlong handle) {
  return reinterpret_cast<T*>(static_cast<intptr_t>(handle));
}

// The first byte of a direct buffer that holds at least size bytes; otherwise NULL, to which the
// function that is called objects.
inline void* Bytes(JNIEnv* env, jobject buffer, jlong size) {
  if (buffer == nullptr || size < 0 || env->GetDirectBufferCapacity(buffer) < size) return nullptr;
  return env->GetDirectBufferAddress(buffer);
}

// The same for count structs of the size that the first of them states.
template <typename T>
T* Structs(JNIEnv* env, jobject buffer, jlong count) {
  const auto* size = static_cast<const uint32_t*>(Bytes(env, buffer, sizeof(uint32_t)));
  if (size == nullptr) return nullptr;
  return static_cast<T*>(Bytes(env, buffer, static_cast<jlong>(*size) * (count > 0 ? count : 1)));
}

template <typename T>
T* Struct(JNIEnv* env, jobject buffer) {
  return Structs<T>(env, buffer, 1);
}

// A zero-terminated copy of bytes from Java; NULL of null, and where memory ran out.
class Text {
 public:
  Text(JNIEnv* env, jbyteArray bytes) {
    if (bytes == nullptr) return;
    const jsize length = env->GetArrayLength(bytes);
    text_ = static_cast<char*>(calloc(static_cast<size_t>(length) + 1, 1));
    if (text_ != nullptr) {
      env->GetByteArrayRegion(bytes, 0, length, reinterpret_cast<jbyte*>(text_));
    }
  }
  Text(const Text&) = delete;
  Text& operator=(const Text&) = delete;
  ~Text() { free(text_); }

  const char* get() const { return text_; }

 private:
  char* text_ = nullptr;
};

// Bytes for Java, where they become a string; null, with Java's own error pending, where memory ran
// out.
inline jbyteArray ToJava(JNIEnv* env, const char* text) {
  const auto length = static_cast<jsize>(strlen(text));
  jbyteArray bytes = env->NewByteArray(length);
  if (bytes != nullptr) {
    env->SetByteArrayRegion(bytes, 0, length, reinterpret_cast<const jbyte*>(text));
  }
  return bytes;
}

// What the shim knows of lodemark.h: a line "name number" for each size, offset and constant that
// Java repeats.
const char* LayoutText();

// Into the first element of an array made for it.
inline void Put(JNIEnv* env, jlongArray out, int64_t value) {
  const jlong stored = value;
  env->SetLongArrayRegion(out, 0, 1, &stored);
}
inline void PutHandle(JNIEnv* env, jlongArray out, const void* handle) {
  Put(env, out, static_cast<int64_t>(reinterpret_cast<intptr_t>(handle)));
}
inline void Put(JNIEnv* env, jintArray out, int32_t value) {
  const jint stored = value;
  env->SetIntArrayRegion(out, 0, 1, &stored);
}

}  // namespace lodemark_jni
