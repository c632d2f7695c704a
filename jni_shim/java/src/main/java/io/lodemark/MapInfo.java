package io.lodemark;

import java.nio.ByteBuffer;

/** What a map says of itself. */
public final class MapInfo {
  private final long landmarks;
  private final long descriptors;
  private final long images;
  private final long buildingParts;
  private final double[] originGeodetic;
  private final double epochYear;
  private final String id;
  private final String datum;
  private final String provenance;

  MapInfo(ByteBuffer struct, int at) {
    landmarks = struct.getLong(at + Layout.MapInfo.LANDMARKS);
    descriptors = struct.getLong(at + Layout.MapInfo.DESCRIPTORS);
    images = struct.getLong(at + Layout.MapInfo.IMAGES);
    buildingParts = struct.getLong(at + Layout.MapInfo.BUILDING_PARTS);
    originGeodetic = Struct.doubles(struct, at + Layout.MapInfo.ORIGIN_GEODETIC, 3);
    epochYear = struct.getDouble(at + Layout.MapInfo.EPOCH_YEAR);
    id = Struct.text(struct, at + Layout.MapInfo.ID, 40);
    datum = Struct.text(struct, at + Layout.MapInfo.DATUM, 64);
    provenance = Struct.text(struct, at + Layout.MapInfo.PROVENANCE, 256);
  }

  /**
   * How many landmarks it has.
   *
   * @return their number
   */
  public long getLandmarks() {
    return landmarks;
  }

  /**
   * How many descriptors it has.
   *
   * @return their number
   */
  public long getDescriptors() {
    return descriptors;
  }

  /**
   * How many photographs it was made of.
   *
   * @return their number
   */
  public long getImages() {
    return images;
  }

  /**
   * How many convex parts of buildings it has.
   *
   * @return their number
   */
  public long getBuildingParts() {
    return buildingParts;
  }

  /**
   * The origin of its frame.
   *
   * @return latitude, longitude, height
   */
  public double[] getOriginGeodetic() {
    return originGeodetic.clone();
  }

  /**
   * Of its coordinates, as 2024.5; 0: unknown.
   *
   * @return the year
   */
  public double getEpochYear() {
    return epochYear;
  }

  /**
   * Its identity.
   *
   * @return 32 hexadecimal digits
   */
  public String getId() {
    return id;
  }

  /**
   * What its coordinates refer to.
   *
   * @return the datum
   */
  public String getDatum() {
    return datum;
  }

  /**
   * Where it comes from.
   *
   * @return the text
   */
  public String getProvenance() {
    return provenance;
  }
}
