package io.lodemark.android;

import static org.junit.Assert.assertEquals;
import static org.junit.Assert.assertTrue;

import java.nio.file.Path;
import java.util.Iterator;
import org.junit.Test;
import org.junit.runner.RunWith;
import org.robolectric.RobolectricTestRunner;
import org.robolectric.annotation.Config;
import sample.FirstFixKt;

/** The sample in Kotlin. Here because natives are loaded once in a virtual machine. */
@RunWith(RobolectricTestRunner.class)
@Config(sdk = 34, manifest = Config.NONE)
public class KotlinSampleTest {
  @Test
  public void itTellsAPlaceForEachSecond() throws Exception {
    Path walk = Recorded.ROOT.resolve("sample_logs/walk");
    Iterator<String> lines = FirstFixKt.positions(walk).iterator();
    int count = 0;
    for (; lines.hasNext(); ++count) {
      String line = lines.next();
      assertTrue(line, line.startsWith("30.52"));
    }
    assertEquals(120, count);
  }
}
