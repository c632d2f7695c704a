package io.lodemark.sample;

import android.Manifest;
import android.app.Activity;
import android.content.pm.PackageManager;
import android.os.Bundle;
import android.widget.LinearLayout;
import android.widget.TextView;
import io.lodemark.Estimate;
import io.lodemark.Estimator;
import io.lodemark.FeatureMap;
import io.lodemark.LandmarkStatus;
import io.lodemark.LodemarkException;
import io.lodemark.PositioningSession;
import io.lodemark.SatelliteStatus;
import io.lodemark.TimeBase;
import io.lodemark.Verdict;
import io.lodemark.android.FeedCheck;
import io.lodemark.android.FeedListener;
import io.lodemark.android.SensorFeed;
import java.io.File;
import java.io.IOException;
import java.nio.file.Files;
import java.util.List;
import java.util.Locale;

/**
 * One screen: the sky, where the phone is, how well that is known, and what the camera recognised.
 *
 * <p>Two files in the app's own folder are used where they are there: navigation.rnx, the broadcast
 * ephemerides of today, and map.lodemark, a map of landmarks around. Without the first it takes
 * half a minute until the satellites have told their orbits, if the receiver passes that on.
 */
public final class MainActivity extends Activity implements FeedListener {
  private static final int PERMISSIONS = 1;

  private TextView text;
  private SkyView sky;
  private String problem = "";
  private PositioningSession session;
  private FeatureMap map;
  private SensorFeed feed;
  private PhotoSource photos;

  @Override
  protected void onCreate(Bundle state) {
    super.onCreate(state);
    sky = new SkyView(this);
    text = new TextView(this);
    text.setPadding(32, 32, 32, 32);
    LinearLayout screen = new LinearLayout(this);
    screen.setOrientation(LinearLayout.VERTICAL);
    screen.addView(sky, new LinearLayout.LayoutParams(-1, 0, 1f));
    screen.addView(text, new LinearLayout.LayoutParams(-1, -2));
    setContentView(screen);
    openSession();
    feed = SensorFeed.builder(this, session).listener(this).build();
    photos = new PhotoSource(this, feed, this::onProblem);
    requestPermissions(new String[] {Manifest.permission.ACCESS_FINE_LOCATION,
                           Manifest.permission.ACCESS_COARSE_LOCATION, Manifest.permission.CAMERA},
        PERMISSIONS);
  }

  private void openSession() {
    session =
        PositioningSession.builder().timeBase(TimeBase.BOOT).estimator(Estimator.FILTER).open();
    File orbits = new File(getFilesDir(), "navigation.rnx");
    File landmarks = new File(getFilesDir(), "map.lodemark");
    try {
      if (orbits.exists())
        session.pushNavigation(orbits.getName(), Files.readAllBytes(orbits.toPath()));
      if (landmarks.exists()) {
        map = FeatureMap.open(landmarks.toPath());
        session.useMap(map);
      }
    } catch (IOException | LodemarkException refusal) {
      onProblem(refusal.getMessage());
    }
  }

  @Override
  protected void onStart() {
    super.onStart();
    startFeed();
  }

  @Override
  public void onRequestPermissionsResult(int request, String[] permissions, int[] results) {
    startFeed();
  }

  private void startFeed() {
    List<String> obstacles = FeedCheck.of(this).getObstacles();
    if (!obstacles.isEmpty()) {
      onProblem(String.join("\n", obstacles));
      return;
    }
    feed.start();
    if (map != null
        && checkSelfPermission(Manifest.permission.CAMERA) == PackageManager.PERMISSION_GRANTED)
      photos.start();
  }

  @Override
  protected void onStop() {
    photos.stop();
    feed.stop();
    super.onStop();
  }

  @Override
  protected void onDestroy() {
    feed.close();
    session.close();
    if (map != null)
      map.close();
    super.onDestroy();
  }

  /** On the feed's thread: what is shown is fetched here and drawn by the main one. */
  @Override
  public void onEstimate(PositioningSession from, Estimate estimate) {
    List<SatelliteStatus> satellites = from.satellites();
    List<LandmarkStatus> landmarks = from.landmarks();
    runOnUiThread(() -> {
      if (!satellites.isEmpty())
        sky.show(satellites);
      text.setText(describe(estimate, landmarks));
    });
  }

  @Override
  public void onProblem(String sentence) {
    runOnUiThread(() -> {
      problem = sentence;
      text.setText(problem);
    });
  }

  private String describe(Estimate estimate, List<LandmarkStatus> landmarks) {
    StringBuilder lines = new StringBuilder();
    if (estimate.hasPosition()) {
      lines.append(String.format(Locale.ROOT, "%.7f° %.7f° %.1f m\nwithin %.1f m, height %.1f m",
          estimate.getLatitudeDegrees(), estimate.getLongitudeDegrees(), estimate.getHeightMeters(),
          estimate.getAccuracyMeters(), estimate.getVerticalAccuracyMeters()));
    } else {
      lines.append("No position: ").append(estimate.getOutcome());
    }
    lines.append("\nSatellites: ").append(estimate.getSatellitesUsed());
    lines.append(" of ").append(estimate.getSatellitesSeen());
    int used = 0;
    for (LandmarkStatus landmark : landmarks) used += landmark.getVerdict() == Verdict.USED ? 1 : 0;
    if (!landmarks.isEmpty())
      lines.append("\nLandmarks: ").append(used).append(" of ").append(landmarks.size());
    lines.append("\nPhotograph: ").append(estimate.getPhoto());
    if (!problem.isEmpty())
      lines.append("\n\n").append(problem);
    return lines.toString();
  }
}
