package io.lodemark;

import static org.junit.jupiter.api.Assertions.assertEquals;
import static org.junit.jupiter.api.Assertions.assertTrue;
import static org.junit.jupiter.api.Assumptions.assumeTrue;

import java.io.ByteArrayOutputStream;
import java.io.File;
import java.io.IOException;
import java.io.PrintStream;
import java.net.URI;
import java.net.URL;
import java.net.URLClassLoader;
import java.nio.charset.StandardCharsets;
import java.nio.file.Files;
import java.nio.file.Path;
import java.nio.file.Paths;
import java.util.ArrayList;
import java.util.List;
import java.util.regex.Matcher;
import java.util.regex.Pattern;
import javax.tools.JavaCompiler;
import javax.tools.JavaFileObject;
import javax.tools.SimpleJavaFileObject;
import javax.tools.ToolProvider;
import org.junit.jupiter.api.Test;
import org.junit.jupiter.api.io.TempDir;

/** The README's first example, and whether it finds what the command finds. */
class FirstExampleTest {
  @TempDir Path folder;

  /** The first block of Java in the README, to the letter. */
  private static String example() {
    String readme = new String(
        Recorded.read(Recorded.ROOT.resolve("jni_shim/README.md")), StandardCharsets.UTF_8);
    Matcher block = Pattern.compile("```java\n(.*?)```", Pattern.DOTALL).matcher(readme);
    assertTrue(block.find());
    return block.group(1);
  }

  private void compile(String name, String source) {
    JavaFileObject file = new SimpleJavaFileObject(
        URI.create("string:///" + name + ".java"), JavaFileObject.Kind.SOURCE) {
      @Override
      public CharSequence getCharContent(boolean ignoreEncodingErrors) {
        return source;
      }
    };
    JavaCompiler compiler = ToolProvider.getSystemJavaCompiler();
    List<String> options = List.of(
        "-d", folder.toString(), "-cp", System.getProperty("java.class.path"), "-Xlint:all");
    assertTrue(compiler.getTask(null, null, null, options, null, List.of(file)).call());
  }

  private String run(String name, String... arguments) throws Exception {
    PrintStream console = System.out;
    ByteArrayOutputStream said = new ByteArrayOutputStream();
    URL[] path = {folder.toUri().toURL()};
    try (URLClassLoader loader = new URLClassLoader(path, getClass().getClassLoader())) {
      System.setOut(new PrintStream(said, true, StandardCharsets.UTF_8));
      loader.loadClass(name).getMethod("main", String[].class).invoke(null, (Object) arguments);
    } finally {
      System.setOut(console);
    }
    return said.toString(StandardCharsets.UTF_8);
  }

  /** The rows of trajectory.csv of a replay of the same recording, without the heading. */
  private List<String[]> replay() throws IOException, InterruptedException {
    Path command = Paths.get(System.getProperty("lodemark.command", "none"));
    assumeTrue(Files.isExecutable(command), "the command lodemark was not built");
    Path run = folder.resolve("run");
    Process process = new ProcessBuilder(
        command.toString(), "replay", Recorded.WALK.toString(), "--out", run.toString())
                          .redirectErrorStream(true)
                          .redirectOutput(new File(folder.toFile(), "replay.log"))
                          .start();
    assertEquals(0, process.waitFor());
    List<String[]> rows = new ArrayList<>();
    for (String line : Files.readAllLines(run.resolve("trajectory.csv"))) rows.add(line.split(","));
    return rows.subList(1, rows.size());
  }

  @Test
  void theReadmesFirstExampleFindsWhereThePhoneWas() throws Exception {
    compile("FirstFix", example());
    String[] lines = run("FirstFix", Recorded.WALK.toString()).split("\n");
    List<String> truth = Files.readAllLines(Recorded.WALK.resolve("truth.csv"));
    // A line for each second; where the walk begins and ends, within some thirty metres.
    assertEquals(120, lines.length);
    assertNear(truth.get(1).split(","), lines[0].split(", "));
    assertNear(truth.get(truth.size() - 1).split(","), lines[lines.length - 1].split(", "));
  }

  private static void assertNear(String[] truth, String[] found) {
    assertEquals(Double.parseDouble(truth[1]), Double.parseDouble(found[0]), 3e-4);
    assertEquals(Double.parseDouble(truth[2]), Double.parseDouble(found[1]), 3e-4);
  }

  @Test
  void fixesAreThoseOfTheReplay() throws Exception {
    List<String[]> rows = replay();
    try (PositioningSession session = PositioningSession.open();
        GnssLog log = GnssLog.open(Recorded.WALK.resolve("gnss_log.txt"))) {
      session.pushNavigation(
          "navigation.rnx", Recorded.read(Recorded.WALK.resolve("navigation.rnx")));
      int row = 0;
      while (log.pushNext(session)) {
        assertTrue(session.process());
        Estimate estimate = session.estimate();
        if (!estimate.hasPosition())
          continue;
        String[] expected = rows.get(row++);
        assertEquals(Long.parseLong(expected[0]), estimate.getTimeGpsNanos());
        assertEquals(Double.parseDouble(expected[1]), estimate.getLatitudeDegrees(), 1e-9);
        assertEquals(Double.parseDouble(expected[2]), estimate.getLongitudeDegrees(), 1e-9);
        assertEquals(Double.parseDouble(expected[3]), estimate.getHeightMeters(), 1e-3);
      }
      assertEquals(rows.size(), row);
    }
  }
}
