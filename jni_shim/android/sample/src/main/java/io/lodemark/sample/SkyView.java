package io.lodemark.sample;

import android.content.Context;
import android.graphics.Canvas;
import android.graphics.Color;
import android.graphics.Paint;
import android.view.View;
import io.lodemark.SatelliteStatus;
import io.lodemark.Verdict;
import java.util.ArrayList;
import java.util.List;

/** The sky: zenith in the middle, north up, east right; a full dot for a satellite that is used. */
public final class SkyView extends View {
  private static final int[] COLOURS = {
      0xFF1B66B1, 0xFFB1331B, 0xFF1B8A4B, 0xFFB8860B, 0xFF6A3FA0, 0xFF2F4F4F, 0xFF808080};

  private final Paint line = new Paint(Paint.ANTI_ALIAS_FLAG);
  private final Paint dot = new Paint(Paint.ANTI_ALIAS_FLAG);
  private List<SatelliteStatus> satellites = new ArrayList<>();

  public SkyView(Context context) {
    super(context);
    line.setStyle(Paint.Style.STROKE);
    line.setColor(Color.GRAY);
    line.setStrokeWidth(2f);
    dot.setTextSize(28f);
  }

  public void show(List<SatelliteStatus> seen) {
    satellites = seen;
    invalidate();
  }

  /** How many dots it draws. */
  public int count() {
    int count = 0;
    for (SatelliteStatus satellite : satellites) count += satellite.hasDirection() ? 1 : 0;
    return count;
  }

  @Override
  protected void onDraw(Canvas canvas) {
    float x = 0.5f * getWidth();
    float y = 0.5f * getHeight();
    float horizon = 0.9f * Math.min(x, y);
    for (int ring = 1; ring <= 3; ++ring) canvas.drawCircle(x, y, horizon * ring / 3f, line);
    canvas.drawLine(x - horizon, y, x + horizon, y, line);
    canvas.drawLine(x, y - horizon, x, y + horizon, line);
    for (SatelliteStatus satellite : satellites) {
      if (satellite.hasDirection())
        draw(canvas, satellite, x, y, horizon);
    }
  }

  private void draw(Canvas canvas, SatelliteStatus satellite, float x, float y, float horizon) {
    double azimuth = Math.toRadians(satellite.getAzimuthDegrees());
    double distance = horizon * (90.0 - satellite.getElevationDegrees()) / 90.0;
    float right = x + (float) (distance * Math.sin(azimuth));
    float down = y - (float) (distance * Math.cos(azimuth));
    boolean used =
        satellite.getVerdict() == Verdict.USED || satellite.getVerdict() == Verdict.DOWN_WEIGHTED;
    dot.setColor(COLOURS[satellite.getSystem().ordinal() % COLOURS.length]);
    dot.setStyle(used ? Paint.Style.FILL : Paint.Style.STROKE);
    canvas.drawCircle(right, down, 12f, dot);
    dot.setStyle(Paint.Style.FILL);
    String name = "" + satellite.getSystem().getLetter() + satellite.getSatellite();
    canvas.drawText(name, right + 16f, down + 10f, dot);
  }
}
