package io.lodemark;

import java.nio.ByteBuffer;

/** What a file that was pushed held. */
public final class ReadReport {
  private final long rowsRead;
  private final long rowsSkipped;
  private final long rowsUnknown;
  private final String firstProblem;

  ReadReport(ByteBuffer struct, int at) {
    rowsRead = struct.getLong(at + Layout.ReadReport.ROWS_READ);
    rowsSkipped = struct.getLong(at + Layout.ReadReport.ROWS_SKIPPED);
    rowsUnknown = struct.getLong(at + Layout.ReadReport.ROWS_UNKNOWN);
    firstProblem = Struct.text(struct, at + Layout.ReadReport.FIRST_PROBLEM, 256);
  }

  /**
   * Rows or records that were taken.
   *
   * @return their number
   */
  public long getRowsRead() {
    return rowsRead;
  }

  /**
   * Malformed ones, which were left out.
   *
   * @return their number
   */
  public long getRowsSkipped() {
    return rowsSkipped;
  }

  /**
   * Those of a kind that this version does not know.
   *
   * @return their number
   */
  public long getRowsUnknown() {
    return rowsUnknown;
  }

  /**
   * "name:line:column: why" of the first malformed row; "" if there was none.
   *
   * @return the text
   */
  public String getFirstProblem() {
    return firstProblem;
  }
}
