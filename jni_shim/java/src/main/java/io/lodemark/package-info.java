/**
 * Where a phone is, from satellites and, in one adjustment with them, known landmarks.
 *
 * <p>A {@link io.lodemark.PositioningSession} takes raw GNSS measurements and photographs and gives
 * an
 * {@link io.lodemark.Estimate} at each of them. The steps it takes are there one by one, too: see
 * {@link io.lodemark.Geodetic}, {@link io.lodemark.Lens}, {@link io.lodemark.FeatureMap}, {@link
 * io.lodemark.Resection} and {@link io.lodemark.RangeSolver}.
 *
 * <p><b>Conventions.</b> Coordinates are WGS 84, heights above the ellipsoid, angles degrees,
 * lengths metres, times nanoseconds. An accuracy is the distance that holds the truth 68 % of the
 * time, a sigma one standard deviation, a covariance a 3 x 3 matrix by rows.
 *
 * <p><b>Failure.</b> What the library refuses is a {@link io.lodemark.LodemarkException} with its
 * status and a sentence that names the field, file or record. Arguments that are wrong already as
 * Java (null, a buffer that is not direct or too small) are a {@link
 * java.lang.NullPointerException} or an {@link java.lang.IllegalArgumentException}, use after close
 * an {@link java.lang.IllegalStateException}. Where there is no position, that is an answer and no
 * exception.
 *
 * <p><b>Threads.</b> Objects that are closed (session, map, undistortion) may be used and closed by
 * any number of threads: each call has a lock. {@link io.lodemark.GnssEpoch} and {@link
 * io.lodemark.CameraImage} are filled and pushed by one thread at a time. All other objects do not
 * change.
 */
package io.lodemark;
