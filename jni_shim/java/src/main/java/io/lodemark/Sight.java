package io.lodemark;

import java.nio.ByteBuffer;

/** A landmark and where a photograph shows it. */
public final class Sight {
  /** All of it but struct_size. */
  private final byte[] struct = new byte[Layout.Sight.SIZE];

  private Sight() {}

  /**
   * A sight of an exact landmark.
   *
   * @param pixelX column at which it is seen
   * @param pixelY row at which it is seen
   * @param landmarkInEcef x, y, z of the landmark
   */
  public Sight(double pixelX, double pixelY, double[] landmarkInEcef) {
    Struct.checked(landmarkInEcef, 3, "landmarkInEcef");
    ByteBuffer view = view();
    Struct.putDoubles(view, Layout.Sight.PIXEL_PX, pixelX, pixelY);
    Struct.putDoubles(view, Layout.Sight.LANDMARK_IN_ECEF_M, landmarkInEcef);
  }

  static Sight read(ByteBuffer structs, int at) {
    Sight sight = new Sight();
    ByteBuffer from = structs.duplicate();
    from.position(at);
    from.get(sight.struct);
    return sight;
  }

  void write(ByteBuffer structs, int at) {
    ByteBuffer to = structs.duplicate();
    to.position(at + 4);
    to.put(struct, 4, struct.length - 4);
  }

  /**
   * Its number in the map.
   *
   * @return the number; 0 if it is of no map
   */
  public long getLandmarkId() {
    return Integer.toUnsignedLong(view().getInt(Layout.Sight.LANDMARK_ID));
  }

  /**
   * Where it is seen.
   *
   * @return x, y
   */
  public double[] getPixel() {
    return Struct.doubles(view(), Layout.Sight.PIXEL_PX, 2);
  }

  /**
   * Where the landmark is.
   *
   * @return x, y, z, earth-centred and earth-fixed
   */
  public double[] getLandmarkInEcef() {
    return Struct.doubles(view(), Layout.Sight.LANDMARK_IN_ECEF_M, 3);
  }

  private ByteBuffer view() {
    return ByteBuffer.wrap(struct).order(java.nio.ByteOrder.nativeOrder());
  }
}
