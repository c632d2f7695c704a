package io.lodemark;

/** From constants of lodemark.h, which count from 0, to enums in their order. */
final class Enums {
  private Enums() {}

  /** The last one, which stands for what this version does not know, if there is none at index. */
  static <E> E at(E[] values, long index) {
    return values[index >= 0 && index < values.length ? (int) index : values.length - 1];
  }
}
