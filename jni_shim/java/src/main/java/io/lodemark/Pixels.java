package io.lodemark;

import java.nio.ByteBuffer;

/** Buffers of pixels and file contents that users pass in. */
final class Pixels {
  private Pixels() {}

  /** A view of what remains in a direct buffer, which must be at least size bytes. */
  static ByteBuffer direct(ByteBuffer buffer, long size, String what) {
    if (!buffer.isDirect())
      throw new IllegalArgumentException(what + " is not a direct buffer");
    if (buffer.remaining() < size) {
      throw new IllegalArgumentException(
          what + " has " + buffer.remaining() + " bytes, not " + size);
    }
    return buffer.slice();
  }

  /** The same bytes in a direct buffer. */
  static ByteBuffer copy(byte[] bytes) {
    ByteBuffer direct = Struct.bytes(bytes.length);
    direct.duplicate().put(bytes);
    return direct;
  }
}
