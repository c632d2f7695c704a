package io.lodemark;

/** The library itself. */
public final class Lodemark {
  private Lodemark() {}

  /**
   * The version of the library that runs.
   *
   * @return such as "0.1.0"
   */
  public static String version() {
    return Native.text(Native.version());
  }
}
