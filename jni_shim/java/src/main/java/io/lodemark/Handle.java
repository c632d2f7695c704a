package io.lodemark;

/**
 * A native object: used by one thread at a time, which its lock sees to, and closed once. Who needs
 * two locks takes that of a log first, then that of a session, then that of a map.
 */
abstract class Handle implements AutoCloseable {
  final Object lock = new Object();
  private final String name;
  private long address;

  Handle(String name, long address) {
    this.name = name;
    this.address = address;
  }

  /** With the lock held: the object's address. */
  final long address() {
    if (address == 0)
      throw new IllegalStateException(name + " is closed");
    return address;
  }

  /** With the lock held: the address a last time, or 0 if it was taken already. */
  final long take() {
    long taken = address;
    address = 0;
    return taken;
  }

  /** Gives back what it holds. Closing again does nothing. */
  @Override public abstract void close();
}
