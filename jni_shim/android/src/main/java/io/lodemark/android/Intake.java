package io.lodemark.android;

import java.util.ArrayDeque;
import java.util.EnumMap;
import java.util.Map;

/**
 * What waits for the feed's thread, in the order it came and with a bound for each kind: when one
 * too many comes, the oldest of its kind goes. Used by any thread.
 */
final class Intake {
  /** Something that waits. */
  static final class Item {
    final FeedKind kind;
    final Object value;
    final long arrivalNanos; // since boot
    private final long order;

    Item(FeedKind kind, Object value, long arrivalNanos, long order) {
      this.kind = kind;
      this.value = value;
      this.arrivalNanos = arrivalNanos;
      this.order = order;
    }
  }

  private final Map<FeedKind, ArrayDeque<Item>> queues = new EnumMap<>(FeedKind.class);
  private final Sample[] samples = new Sample[FeedKind.SAMPLE.getCapacity()];
  private final long[] sampleOrders = new long[samples.length];
  private int firstSample;
  private int sampleCount;
  private long orders;

  Intake() {
    for (FeedKind kind : FeedKind.values()) queues.put(kind, new ArrayDeque<>());
    for (int i = 0; i < samples.length; ++i) samples[i] = new Sample();
  }

  /** What had to go for it; null if nothing. */
  synchronized Object offer(FeedKind kind, Object value, long arrivalNanos) {
    ArrayDeque<Item> queue = queues.get(kind);
    Item oldest = queue.size() == kind.getCapacity() ? queue.poll() : null;
    queue.add(new Item(kind, value, arrivalNanos, orders++));
    return oldest == null ? null : oldest.value;
  }

  /** Copies a sample; true if the oldest one had to go for it. */
  synchronized boolean offer(int sensorType, long timestamp, float[] values) {
    boolean full = sampleCount == samples.length;
    if (full)
      removeSample();
    int at = (firstSample + sampleCount) % samples.length;
    samples[at].set(sensorType, timestamp, values);
    sampleOrders[at] = orders++;
    ++sampleCount;
    return full;
  }

  /** Copies the oldest sample if it is the oldest of all that waits. */
  synchronized boolean takeSample(Sample to) {
    if (sampleCount == 0)
      return false;
    Item item = oldest();
    if (item != null && item.order < sampleOrders[firstSample])
      return false;
    to.copy(samples[firstSample]);
    removeSample();
    return true;
  }

  /** The oldest that is no sample; null if there is none. */
  synchronized Item take() {
    Item item = oldest();
    if (item != null)
      queues.get(item.kind).remove();
    return item;
  }

  /** The oldest of one kind; null if there is none. */
  synchronized Object take(FeedKind kind) {
    Item item = queues.get(kind).poll();
    return item == null ? null : item.value;
  }

  /** Forgets what came too late for the thread that has ended. */
  synchronized void clear() {
    for (ArrayDeque<Item> queue : queues.values()) queue.clear();
    sampleCount = 0;
  }

  private Item oldest() {
    Item oldest = null;
    for (ArrayDeque<Item> queue : queues.values()) {
      Item first = queue.peek();
      if (first != null && (oldest == null || first.order < oldest.order))
        oldest = first;
    }
    return oldest;
  }

  private void removeSample() {
    firstSample = (firstSample + 1) % samples.length;
    --sampleCount;
  }
}
