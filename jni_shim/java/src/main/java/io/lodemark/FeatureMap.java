package io.lodemark;

import java.nio.ByteBuffer;
import java.nio.file.Path;
import java.util.ArrayList;
import java.util.List;

/**
 * Surveyed landmarks and what they look like, in one file that is only read. To be closed; sessions
 * that use it keep the file open for themselves until they are closed too. Any number of threads
 * and sessions may use it; they take turns.
 */
public final class FeatureMap extends Handle {
  private int users;
  private boolean closed;

  private FeatureMap(long address) {
    super("map", address);
  }

  /**
   * Opens a map file, in a time that does not grow with the map. Any file is safe to open: what is
   * damaged gives {@link LodemarkException.Status#BAD_DATA}, here or when it is met.
   *
   * @param path of the file
   * @return an open map
   */
  public static FeatureMap open(Path path) {
    long[] out = new long[1];
    Native.check(Native.mapOpen(Native.bytes(path.toString(), "path"), out));
    return new FeatureMap(out[0]);
  }

  /**
   * What the map says of itself.
   *
   * @return its content and origin
   */
  public MapInfo getInfo() {
    ByteBuffer info = Struct.of(Layout.MapInfo.SIZE);
    synchronized (lock) {
      Native.check(Native.mapReadInfo(open(), info));
    }
    return new MapInfo(info, 0);
  }

  /**
   * Where a photograph was taken.
   *
   * @param image the photograph; of how it was taken, nothing is used but what prior says
   * @param prior what is known of the camera; null for nothing
   * @return its pose, or why there is none
   */
  public Pose locate(CameraImage image, ViewPrior prior) {
    ByteBuffer pose = Struct.of(Layout.Pose.SIZE);
    synchronized (lock) {
      Native.check(Native.mapLocate(open(), image.lens().struct(), image.pixels(), image.size(),
          image.strideBytes(), prior == null ? null : prior.struct(), pose));
    }
    return new Pose(pose, 0);
  }

  /**
   * What of the map a photograph shows: each feature that is taken for a landmark, the surest
   * first.
   *
   * @param image the photograph
   * @param prior what is known of the camera; null for nothing
   * @return the sights, many of which may be mistaken: see {@link Resection}
   */
  public List<Sight> query(CameraImage image, ViewPrior prior) {
    int capacity = Values.LARGEST_COUNT;
    ByteBuffer out = Struct.array(Layout.Sight.SIZE, capacity);
    int[] total = new int[1];
    synchronized (lock) {
      Native.check(Native.mapQuery(open(), image.lens().struct(), image.pixels(), image.size(),
          image.strideBytes(), prior == null ? null : prior.struct(), out, capacity, total));
    }
    List<Sight> sights = new ArrayList<>();
    for (int i = 0; i < Math.min(total[0], capacity); ++i) {
      sights.add(Sight.read(out, i * Layout.Sight.SIZE));
    }
    return sights;
  }

  @Override
  public void close() {
    synchronized (lock) {
      closed = true;
      if (users == 0)
        Native.mapClose(take());
    }
  }

  /** With the lock held: its address for its own methods, which end with close. */
  private long open() {
    if (closed)
      throw new IllegalStateException("map is closed");
    return address();
  }

  /** With the lock held: its address for a session that begins to use it. */
  long acquire() {
    long address = open();
    ++users;
    return address;
  }

  void release() {
    synchronized (lock) {
      --users;
      if (closed && users == 0)
        Native.mapClose(take());
    }
  }
}
