package io.lodemark.android;

import static org.junit.Assert.assertEquals;
import static org.junit.Assert.assertTrue;

import io.lodemark.Estimate;
import io.lodemark.PositioningSession;
import java.util.ArrayList;
import java.util.Collections;
import java.util.List;
import java.util.concurrent.Semaphore;
import java.util.concurrent.TimeUnit;

/** Listens to a feed, and lets who feeds it wait for the answer. */
final class FedFixes implements FeedListener {
  final List<Estimate> estimates = Collections.synchronizedList(new ArrayList<>());
  final List<String> problems = Collections.synchronizedList(new ArrayList<>());
  private final Semaphore told = new Semaphore(0);

  @Override
  public void onEstimate(PositioningSession session, Estimate estimate) {
    estimates.add(estimate);
    told.release();
  }

  @Override
  public void onProblem(String problem) {
    problems.add(problem);
  }

  /** Until an estimate was told of what was given last. */
  void await() {
    try {
      assertTrue("no estimate came; " + problems, told.tryAcquire(20, TimeUnit.SECONDS));
    } catch (InterruptedException interruption) {
      throw new AssertionError(interruption);
    }
  }

  List<Estimate> positions() {
    List<Estimate> positions = new ArrayList<>();
    synchronized (estimates) {
      for (Estimate estimate : estimates) {
        if (estimate.hasPosition())
          positions.add(estimate);
      }
    }
    return positions;
  }

  /** The same moments and places, to 0.1 mm. */
  void assertAre(List<String[]> rows) {
    List<Estimate> positions = positions();
    for (int i = 0; i < Math.min(rows.size(), positions.size()); ++i) {
      assertEquals("moment " + i + ": " + positions.get(i), Long.parseLong(rows.get(i)[0]),
          positions.get(i).getTimeGpsNanos(), 2);
    }
    assertEquals(rows.size(), positions.size());
    for (int i = 0; i < rows.size(); ++i) {
      String[] row = rows.get(i);
      Estimate position = positions.get(i);
      assertEquals(Double.parseDouble(row[1]), position.getLatitudeDegrees(), 1e-9);
      assertEquals(Double.parseDouble(row[2]), position.getLongitudeDegrees(), 1e-9);
      assertEquals(Double.parseDouble(row[3]), position.getHeightMeters(), 1e-3);
    }
  }
}
