package io.lodemark;

import java.io.IOException;
import java.io.InputStream;
import java.io.UncheckedIOException;
import java.nio.file.Files;
import java.nio.file.Path;
import java.nio.file.Paths;

/**
 * Finds and loads the natives: from the folder that the system property {@code lodemark.natives}
 * names; from the jar, where it has those of this platform; or by the system's own search, as on
 * Android.
 */
final class NativeLibrary {
  /** The shim finds the library in its own folder. Loaded in this order. */
  private static final String[] FILES = {"liblodemark.so.1", "liblodemark_jni.so"};

  /** Those that the README lists, too. */
  private static final String PACKAGES = "libopencv-features2d406 libopencv-imgproc406 "
      + "libopencv-core406 libgeographiclib23 libsqlite3-0 libccd2 zlib1g";

  private NativeLibrary() {}

  static void load() {
    String folder = System.getProperty("lodemark.natives");
    if (folder != null) {
      loadFrom(Paths.get(folder).toAbsolutePath());
    } else if (NativeLibrary.class.getResource(resource(FILES[1])) != null) {
      loadFromJar();
    } else {
      loadFromSystem();
    }
  }

  /** As on Android, where the AAR brings the natives. */
  private static void loadFromSystem() {
    try {
      System.loadLibrary("lodemark_jni");
    } catch (UnsatisfiedLinkError cause) {
      throw explained(cause, "this jar has no natives for " + platform());
    }
  }

  private static void loadFrom(Path folder) {
    try {
      for (String file : FILES) System.load(folder.resolve(file).toString());
    } catch (UnsatisfiedLinkError cause) {
      throw explained(cause, "libraries it needs, on Debian 12: apt-get install " + PACKAGES);
    }
  }

  private static UnsatisfiedLinkError explained(UnsatisfiedLinkError cause, String hint) {
    UnsatisfiedLinkError error = new UnsatisfiedLinkError(cause.getMessage() + " (" + hint + ")");
    error.initCause(cause);
    return error;
  }

  /**
   * A loaded file may be removed from Linux's file system while it is in use, so nothing is left
   * behind however the process ends.
   */
  private static void loadFromJar() {
    try {
      Path folder = Files.createTempDirectory("lodemark"); // readable by its owner only
      try {
        for (String file : FILES) extract(file, folder);
        loadFrom(folder);
      } finally {
        for (String file : FILES) Files.deleteIfExists(folder.resolve(file));
        Files.delete(folder);
      }
    } catch (IOException cause) {
      throw new UncheckedIOException("the natives could not be unpacked", cause);
    }
  }

  private static void extract(String file, Path folder) throws IOException {
    try (InputStream in = NativeLibrary.class.getResourceAsStream(resource(file))) {
      if (in == null)
        throw new IOException("the jar lacks " + resource(file));
      Files.copy(in, folder.resolve(file));
    }
  }

  /** Such as /natives/linux-x86_64/liblodemark_jni.so. */
  private static String resource(String file) {
    return "/natives/" + platform() + "/" + file;
  }

  private static String platform() {
    String processor = System.getProperty("os.arch");
    if (processor.equals("amd64"))
      processor = "x86_64";
    return System.getProperty("os.name").toLowerCase(java.util.Locale.ROOT) + "-" + processor;
  }
}
