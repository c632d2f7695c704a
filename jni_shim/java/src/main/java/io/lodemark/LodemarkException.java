package io.lodemark;

/** What the library refused or could not do. The message names the field, file or record. */
public final class LodemarkException extends RuntimeException {
  private static final long serialVersionUID = 1;

  /** Whose move it is. */
  private final Status status;

  LodemarkException(int status, String message) {
    super(message);
    this.status = Status.of(status);
  }

  /**
   * Whose move it is.
   *
   * @return the status; {@link Status#UNKNOWN} where a newer library gave one that this jar does
   *     not know
   */
  public Status getStatus() {
    return status;
  }

  /** The errors of the library. */
  public enum Status {
    /** The caller's: a value or a call that makes no sense. */
    INVALID_ARGUMENT,
    /** The caller's: sound, but this version cannot serve it. */
    UNSUPPORTED,
    /** The caller's: called too early, or time ran backwards. */
    OUT_OF_ORDER,
    /** The caller's: process before pushing more. */
    QUEUE_FULL,
    /** The system's: a file that cannot be opened or read. */
    IO,
    /** The data's: malformed content of a file or message. */
    BAD_DATA,
    /** The system's. */
    OUT_OF_MEMORY,
    /** A bug in the library. */
    INTERNAL,
    /** One of a newer library. */
    UNKNOWN;

    static Status of(int status) {
      return Enums.at(values(), -1 - (long) status);
    }
  }
}
