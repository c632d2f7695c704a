package io.lodemark;

import java.nio.ByteBuffer;
import java.util.Objects;

/**
 * Straightens photographs of one lens; what that takes is worked out once, when it is opened. To be
 * closed. Any number of threads may use it; they take turns.
 */
public final class Undistortion extends Handle {
  private final Lens lens;
  private final Lens target;

  private Undistortion(long address, Lens lens, Lens target) {
    super("undistortion", address);
    this.lens = lens;
    this.target = target;
  }

  /**
   * Into the pinhole lens that shows as much as it can, of the same size, without black corners.
   *
   * @param lens of the photographs
   * @return an open undistortion
   */
  public static Undistortion open(Lens lens) {
    return openInto(lens, null);
  }

  /**
   * Into a given pinhole lens.
   *
   * @param lens of the photographs
   * @param target of the straightened ones
   * @return an open undistortion
   */
  public static Undistortion open(Lens lens, Lens target) {
    return openInto(lens, Objects.requireNonNull(target, "target").struct());
  }

  private static Undistortion openInto(Lens lens, ByteBuffer target) {
    ByteBuffer used = Lens.empty();
    long[] out = new long[1];
    Native.check(Native.undistortionOpen(lens.struct(), target, used, out));
    return new Undistortion(out[0], lens, Lens.of(used));
  }

  /**
   * The lens of the straightened photographs.
   *
   * @return a pinhole lens
   */
  public Lens getTarget() {
    return target;
  }

  /**
   * Straightens one photograph: grey, 8 bits a pixel. Both buffers are direct and read or written
   * from their position on, which stays; they must not overlap.
   *
   * @param pixels of the lens's size
   * @param strideBytes from one row of it to the next
   * @param out of the target's size
   * @param outStrideBytes from one row of it to the next
   */
  public void apply(ByteBuffer pixels, long strideBytes, ByteBuffer out, long outStrideBytes) {
    long size = lens.imageBytes(strideBytes);
    long outSize = target.imageBytes(outStrideBytes);
    ByteBuffer from = Pixels.direct(pixels, size, "pixels");
    if (out.isReadOnly())
      throw new IllegalArgumentException("out is read-only");
    ByteBuffer to = Pixels.direct(out, outSize, "out");
    synchronized (lock) {
      Native.check(Native.undistortionApply(
          address(), from, size, strideBytes, to, outSize, outStrideBytes));
    }
  }

  @Override
  public void close() {
    synchronized (lock) {
      Native.undistortionClose(take());
    }
  }
}
