package io.lodemark;

import static org.junit.jupiter.api.Assertions.assertEquals;
import static org.junit.jupiter.api.Assertions.assertNull;
import static org.junit.jupiter.api.Assertions.assertThrows;
import static org.junit.jupiter.api.Assertions.assertTrue;

import java.nio.file.Paths;
import java.util.ArrayList;
import java.util.List;
import java.util.concurrent.CountDownLatch;
import java.util.concurrent.atomic.AtomicReference;
import org.junit.jupiter.api.Test;
import org.junit.jupiter.api.Timeout;

/** Sessions in several threads, and many of them. */
@Timeout(120)
class ThreadsTest {
  /** Runs them at once, and passes on what one of them threw. */
  static void run(List<Runnable> works) throws InterruptedException {
    AtomicReference<Throwable> thrown = new AtomicReference<>();
    List<Thread> threads = new ArrayList<>();
    for (Runnable work : works) {
      Thread thread = new Thread(work);
      thread.setUncaughtExceptionHandler((which, what) -> thrown.set(what));
      threads.add(thread);
      thread.start();
    }
    for (Thread thread : threads) thread.join();
    assertNull(thrown.get());
  }

  private static void fixAgainAndAgain() {
    GnssEpoch epoch = new GnssEpoch();
    try (PositioningSession session = Recorded.session()) {
      for (int i = 0; i < 100; ++i) {
        session.reset();
        session.pushGnss(Recorded.fill(epoch));
        assertTrue(session.process());
        assertEquals(Recorded.LATITUDE, session.estimate().getLatitudeDegrees(), 1e-5);
        assertEquals(7, session.satellites().size());
      }
    }
  }

  @Test
  void twoSessionsInTwoThreadsDoNotDisturbEachOther() throws InterruptedException {
    run(List.of(ThreadsTest::fixAgainAndAgain, ThreadsTest::fixAgainAndAgain));
  }

  @Test
  void aSessionMayBeClosedWhileAnotherThreadPushes() throws InterruptedException {
    for (int round = 0; round < 50; ++round) {
      PositioningSession session = Recorded.session();
      CountDownLatch pushed = new CountDownLatch(3);
      Runnable push = () -> {
        GnssEpoch epoch = Recorded.fill(new GnssEpoch());
        assertThrows(IllegalStateException.class, () -> {
          while (true) {
            session.pushGnss(epoch);
            pushed.countDown();
            while (session.process()) session.estimate();
            session.satellites();
          }
        });
      };
      Runnable close = () -> {
        try {
          pushed.await();
        } catch (InterruptedException interrupted) {
          throw new AssertionError(interrupted);
        }
        session.close();
      };
      run(List.of(push, push, close));
    }
  }

  @Test
  void errorsBelongToTheirThread() throws InterruptedException {
    Runnable latitude = () -> {
      for (int i = 0; i < 2000; ++i) {
        LodemarkException refused =
            assertThrows(LodemarkException.class, () -> new Geodetic(99, 0, 0).toEcef());
        assertTrue(refused.getMessage().contains("geodetic"), refused.getMessage());
      }
    };
    Runnable ecef = () -> {
      double[] values = {Double.NaN, 0, 0};
      for (int i = 0; i < 2000; ++i) {
        LodemarkException refused =
            assertThrows(LodemarkException.class, () -> Geodetic.fromEcef(values));
        assertTrue(refused.getMessage().contains("ecef"), refused.getMessage());
      }
    };
    run(List.of(latitude, ecef));
  }

  /** Once Java's own garbage, and the direct memory that goes with it, has been given back. */
  private static long residentMegabytes() {
    System.gc();
    String pages = new String(Recorded.read(Paths.get("/proc/self/statm"))).split(" ")[1];
    return Long.parseLong(pages) * 4096 >> 20;
  }

  /** How far memory grows from the second tenth of so many cycles to the last. */
  private static long growth(int cycles, Runnable cycle) {
    long before = 0;
    long after = 0;
    for (int tenth = 1; tenth <= 10; ++tenth) {
      for (int i = 0; i < cycles / 10; ++i) cycle.run();
      after = residentMegabytes();
      if (tenth == 2)
        before = after; // the virtual machine has warmed up
    }
    return after - before;
  }

  @Test
  void openingAndClosingLeavesNothingBehind() {
    SessionBuilder builder = PositioningSession.builder().queueCapacity(1);
    long grownMegabytes = growth(100_000, () -> {
      try (PositioningSession session = builder.open()) {
        assertEquals(0, session.queued());
      }
    });
    // A kilobyte for each of the last 80,000 would be 80 MB.
    assertTrue(grownMegabytes < 40, "grown by " + grownMegabytes + " MB");
  }

  @Test
  void openingWhatIsNoneLeavesNothingBehind() {
    long grownMegabytes = growth(20_000,
        ()
            -> assertThrows(
                LodemarkException.class, () -> FeatureMap.open(Paths.get("no such map"))));
    assertTrue(grownMegabytes < 16, "grown by " + grownMegabytes + " MB");
  }
}
