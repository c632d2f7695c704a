package io.lodemark;

import java.nio.file.Path;

/**
 * A GnssLogger text of any version, plain or gzip, pushed into a session as if it came from the
 * phone. To be closed.
 */
public final class GnssLog extends Handle {
  private GnssLog(long address) {
    super("log", address);
  }

  /**
   * Opens a log file. Any file is safe to open.
   *
   * @param path of the file
   * @return an open log, to be read from its beginning
   */
  public static GnssLog open(Path path) {
    long[] out = new long[1];
    Native.check(Native.logOpen(Native.bytes(path.toString(), "path"), out));
    return new GnssLog(out[0]);
  }

  /**
   * Pushes the next epoch, and first the broadcast messages before it and what the phone's sensors
   * measured until shortly after it, so process each epoch before the next. After {@link
   * LodemarkException.Status#QUEUE_FULL} the same epoch comes again, after any other refusal the
   * next one.
   *
   * @param session takes the epoch
   * @return false after the last epoch
   */
  public boolean pushNext(PositioningSession session) {
    synchronized (lock) {
      long log = address();
      synchronized (session.lock) {
        return Native.check(Native.logPushNext(log, session.address())) != Values.END_OF_LOG;
      }
    }
  }

  @Override
  public void close() {
    synchronized (lock) {
      Native.logClose(take());
    }
  }
}
