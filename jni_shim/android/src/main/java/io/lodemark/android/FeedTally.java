package io.lodemark.android;

/** Counts what became of what was given. Used by any thread. */
final class FeedTally {
  private static final int KINDS = FeedKind.values().length;

  private final long[] given = new long[KINDS];
  private final long[] used = new long[KINDS];
  private final long[] dropped = new long[KINDS];
  private final long[] refused = new long[KINDS];

  synchronized void give(FeedKind kind) {
    ++given[kind.ordinal()];
  }

  synchronized void use(FeedKind kind, int count) {
    used[kind.ordinal()] += count;
  }

  synchronized void refuse(FeedKind kind, int count) {
    refused[kind.ordinal()] += count;
  }

  /** What is to be told of it: at the first, the tenth, the hundredth...; otherwise null. */
  synchronized String drop(FeedKind kind) {
    long count = ++dropped[kind.ordinal()];
    long told = 1;
    while (told < count) told *= 10;
    if (told != count)
      return null;
    return "Of " + kind.plural() + ", " + count + " had to be dropped, as they come faster than "
        + "this phone can follow: give it fewer.";
  }

  synchronized FeedCounts counts() {
    return new FeedCounts(given, used, dropped, refused);
  }
}
