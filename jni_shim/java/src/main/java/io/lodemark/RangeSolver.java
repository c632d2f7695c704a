package io.lodemark;

import java.nio.ByteBuffer;

/**
 * A position from ranges to known points: satellites, whose ranges share the receiver's clock, and
 * landmarks, whose ranges have none. Two satellites and three corners of a shop sign are enough.
 */
public final class RangeSolver {
  private ByteBuffer ranges = Struct.array(Layout.Range.SIZE, 32);
  private final ByteBuffer options = Struct.of(Layout.SolveOptions.SIZE);
  private int count;

  /** Without ranges. */
  public RangeSolver() {}

  /**
   * Adds a range.
   *
   * @param pointInEcef x, y, z of the point; of a satellite at transmission, in the axes of
   *     reception time
   * @param rangeMeters corrected for all but the receiver's clock
   * @param sigmaMeters its standard deviation
   * @param clockGroup 0 if it was measured without a clock; ranges that share a clock error have
   *     the same number of 1 to 16
   * @return this
   */
  public RangeSolver add(
      double[] pointInEcef, double rangeMeters, double sigmaMeters, int clockGroup) {
    Struct.checked(pointInEcef, 3, "pointInEcef");
    if (count == Values.LARGEST_COUNT)
      throw new IllegalStateException("too many ranges");
    int at = count * Layout.Range.SIZE;
    if (at == ranges.capacity()) {
      ByteBuffer larger = Struct.array(Layout.Range.SIZE, 2 * count);
      larger.duplicate().put(ranges.duplicate());
      ranges = larger;
    }
    ranges.putInt(at + Layout.Range.CLOCK_GROUP, clockGroup);
    Struct.putDoubles(ranges, at + Layout.Range.POINT_IN_ECEF_M, pointInEcef);
    ranges.putDouble(at + Layout.Range.RANGE_M, rangeMeters);
    ranges.putDouble(at + Layout.Range.SIGMA_M, sigmaMeters);
    ++count;
    return this;
  }

  /**
   * Where to begin, which decides where two places fit alike.
   *
   * @param ecefMeters x, y, z
   * @return this
   */
  public RangeSolver setStart(double[] ecefMeters) {
    Struct.putDoubles(
        options, Layout.SolveOptions.START_IN_ECEF_M, Struct.checked(ecefMeters, 3, "ecefMeters"));
    Struct.setBit(options, Layout.SolveOptions.PRESENT, Values.SOLVE_HAS_START);
    return this;
  }

  /**
   * Solves for the ranges added so far, which stay.
   *
   * @return the position, or why there is none
   */
  public Solution solve() {
    ByteBuffer solution = Struct.of(Layout.Solution.SIZE);
    ByteBuffer residuals = Struct.array(Layout.RangeResidual.SIZE, Math.max(1, count));
    Native.check(Native.positionSolve(ranges, count, options, solution, residuals));
    return new Solution(solution, residuals, count);
  }

  /** A position, or why there is none; then all numbers are 0. */
  public static final class Solution {
    private final ByteBuffer struct;
    private final ByteBuffer residuals;
    private final int count;

    Solution(ByteBuffer struct, ByteBuffer residuals, int count) {
      this.struct = struct;
      this.residuals = residuals;
      this.count = count;
    }

    /**
     * Why there is a position, or why not.
     *
     * @return {@link Outcome#FIX} if there is one
     */
    public Outcome getOutcome() {
      return Enums.at(Outcome.values(), struct.getInt(Layout.Solution.OUTCOME));
    }

    /**
     * The place.
     *
     * @return latitude, longitude, height
     */
    public Geodetic getPlace() {
      return new Geodetic(struct.getDouble(Layout.Solution.LATITUDE_DEG),
          struct.getDouble(Layout.Solution.LONGITUDE_DEG),
          struct.getDouble(Layout.Solution.HEIGHT_M));
    }

    /**
     * The horizontal distance that holds the truth 68 % of the time.
     *
     * @return metres
     */
    public double getAccuracyMeters() {
      return struct.getDouble(Layout.Solution.ACCURACY_M);
    }

    /**
     * The clock of a group, times the speed of light.
     *
     * @param clockGroup 1 to 16
     * @return metres
     */
    public double getClockMeters(int clockGroup) {
      if (clockGroup < 1 || clockGroup > Values.CLOCK_GROUPS) {
        throw new IndexOutOfBoundsException("no clock group " + clockGroup);
      }
      return struct.getDouble(Layout.Solution.CLOCK_M + 8 * (clockGroup - 1));
    }

    /**
     * Whether a range was used.
     *
     * @param index of the range, in the order of adding
     * @return false of one that contradicts the others
     */
    public boolean isUsed(int index) {
      return residuals.getInt(at(index) + Layout.RangeResidual.USED) != 0;
    }

    /**
     * Measured minus computed.
     *
     * @param index of the range, in the order of adding
     * @return metres
     */
    public double getResidualMeters(int index) {
      return residuals.getDouble(at(index) + Layout.RangeResidual.RESIDUAL_M);
    }

    private int at(int index) {
      if (index < 0 || index >= count)
        throw new IndexOutOfBoundsException("no range " + index);
      return index * Layout.RangeResidual.SIZE;
    }
  }
}
