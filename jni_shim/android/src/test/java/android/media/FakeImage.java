package android.media;

import java.nio.ByteBuffer;

/** An Image that no camera took: here, because Android lets nobody else extend it. */
public final class FakeImage extends Image {
  private final int format;
  private final int width;
  private final int height;
  private final long timestamp;
  private final Plane[] planes;

  /** One plane of bytes. */
  public FakeImage(int format, int width, int height, long timestamp, ByteBuffer bytes,
      int rowStride, int pixelStride) {
    this.format = format;
    this.width = width;
    this.height = height;
    this.timestamp = timestamp;
    planes = new Plane[] {new Plane(){@Override public int getRowStride(){return rowStride;
  }

  @Override
  public int getPixelStride() {
    return pixelStride;
  }

  @Override
  public ByteBuffer getBuffer() {
    return bytes;
  }
}
}
;
mIsImageValid = true;
}

@Override
public int getFormat() {
  return format;
}

@Override
public int getWidth() {
  return width;
}

@Override
public int getHeight() {
  return height;
}

@Override
public long getTimestamp() {
  return timestamp;
}

@Override
public int getTransform() {
  return 0;
}

@Override
public int getScalingMode() {
  return 0;
}

@Override
public Plane[] getPlanes() {
  return planes;
}

@Override
public void close() {
  mIsImageValid = false;
}
}
