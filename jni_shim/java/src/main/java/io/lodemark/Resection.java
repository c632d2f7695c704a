package io.lodemark;

import java.nio.ByteBuffer;
import java.util.List;

/** The pose of a camera from sights, many of which may be mistaken. */
public final class Resection {
  private Resection() {}

  /**
   * Resects.
   *
   * @param lens of the photograph
   * @param sights at most 4096
   * @param prior what is known of the camera, of which position and gravity are used; null for
   *     nothing
   * @return the pose, or why there is none
   */
  public static Pose resect(Lens lens, List<Sight> sights, ViewPrior prior) {
    ByteBuffer structs = Struct.array(Layout.Sight.SIZE, sights.size());
    for (int i = 0; i < sights.size(); ++i) {
      sights.get(i).write(structs, i * Layout.Sight.SIZE);
    }
    ByteBuffer pose = Struct.of(Layout.Pose.SIZE);
    Native.check(Native.poseResect(
        lens.struct(), structs, sights.size(), prior == null ? null : prior.struct(), pose, null));
    return new Pose(pose, 0);
  }
}
