package io.lodemark;

import java.nio.ByteBuffer;
import java.util.ArrayList;
import java.util.List;

/** A list that a native fills, in memory that is kept from call to call. */
final class StructList<T> {
  /** One of the natives that fill a list. */
  interface Source {
    int call(long handle, ByteBuffer out, int capacity, int[] total);
  }

  /** A value class made of one struct. */
  interface Reader<T> {
    T read(ByteBuffer structs, int at);
  }

  private final int size;
  private final Source source;
  private final Reader<T> reader;
  private final int[] total = new int[1];
  private ByteBuffer structs;

  StructList(int size, Source source, Reader<T> reader) {
    this.size = size;
    this.source = source;
    this.reader = reader;
    structs = Struct.of(size);
  }

  List<T> fetch(long handle) {
    Native.check(source.call(handle, structs, structs.capacity() / size, total));
    if (total[0] > structs.capacity() / size) {
      int capacity = total[0] + total[0] / 2;
      structs = Struct.array(size, capacity);
      Native.check(source.call(handle, structs, capacity, total));
    }
    List<T> values = new ArrayList<>(total[0]);
    for (int i = 0; i < total[0]; ++i) values.add(reader.read(structs, i * size));
    return values;
  }
}
