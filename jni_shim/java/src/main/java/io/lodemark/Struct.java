package io.lodemark;

import java.nio.ByteBuffer;
import java.nio.ByteOrder;
import java.nio.charset.StandardCharsets;

/** Structs of lodemark.h in direct buffers: each begins with its size, and the rest is zero. */
final class Struct {
  private Struct() {}

  static ByteBuffer bytes(long size) {
    if (size > Integer.MAX_VALUE)
      throw new IllegalArgumentException("above 2 GB");
    return ByteBuffer.allocateDirect((int) size).order(ByteOrder.nativeOrder());
  }

  static ByteBuffer of(int size) {
    return array(size, 1);
  }

  static ByteBuffer array(int size, int count) {
    ByteBuffer structs = bytes((long) size * count);
    for (int i = 0; i < count; ++i) structs.putInt(i * size, size);
    return structs;
  }

  static void setBit(ByteBuffer struct, int at, int bit) {
    struct.putInt(at, struct.getInt(at) | bit);
  }

  static boolean hasBit(ByteBuffer struct, int at, int bit) {
    return (struct.getInt(at) & bit) != 0;
  }

  static void putDoubles(ByteBuffer struct, int at, double... values) {
    for (int i = 0; i < values.length; ++i) struct.putDouble(at + 8 * i, values[i]);
  }

  static double[] doubles(ByteBuffer struct, int at, int count) {
    double[] values = new double[count];
    for (int i = 0; i < count; ++i) values[i] = struct.getDouble(at + 8 * i);
    return values;
  }

  /** The zero-terminated text in a field of capacity bytes. */
  static String text(ByteBuffer struct, int at, int capacity) {
    byte[] utf8 = new byte[capacity];
    int length = 0;
    while (length < capacity && struct.get(at + length) != 0) {
      utf8[length] = struct.get(at + length);
      ++length;
    }
    return new String(utf8, 0, length, StandardCharsets.UTF_8);
  }

  /** An array that must have just so many values. */
  static double[] checked(double[] values, int count, String what) {
    if (values.length != count) {
      throw new IllegalArgumentException(what + " has " + values.length + " values, not " + count);
    }
    return values;
  }
}
