package io.lodemark;

/** What a position is made of where the session has photographs of its map. */
public enum Scheme {
  /** Landmarks' bearings and satellites' ranges together. */
  JOINT,
  /** Visual ranges beside those of satellites. */
  TIGHT,
  /** The same as if visual ranges were independent, as published. */
  TIGHT_DIAGONAL,
  /** Photographs alone. */
  VISION,
  /** Satellites alone. */
  GNSS
}
