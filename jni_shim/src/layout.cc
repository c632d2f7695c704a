// What Java repeats of lodemark.h, as the compiler of the natives sees it.
#include <stddef.h>
#include <stdio.h>

#include "jni_shim/src/crossing.h"
#include "lodemark/lodemark.h"

namespace lodemark_jni {
namespace {

struct Number {
  const char* name;
  long long value;
};

constexpr Number kNumbers[] = {
#define SIZE(type) {#type, sizeof(lodemark_##type)},
#define FIELD(type, field) {#type "." #field, offsetof(lodemark_##type, field)},
#define VALUE(name) {#name, LODEMARK_##name},
#include "jni_shim/src/layout_fields.h"
};

// Of the longest line.
constexpr size_t kLine = 96;

}  // namespace

const char* LayoutText() {
  static char text[sizeof kNumbers / sizeof kNumbers[0] * kLine];
  size_t used = 0;
  for (const Number& number : kNumbers) {
    used += static_cast<size_t>(
        snprintf(text + used, sizeof text - used, "%s %lld\n", number.name, number.value));
  }
  return text;
}

}  // namespace lodemark_jni
