package io.lodemark.android;

import static org.junit.Assert.assertEquals;
import static org.junit.Assert.assertTrue;
import static org.junit.Assume.assumeTrue;

import java.io.BufferedReader;
import java.io.File;
import java.io.FileInputStream;
import java.io.IOException;
import java.io.InputStream;
import java.io.InputStreamReader;
import java.nio.charset.StandardCharsets;
import java.nio.file.Files;
import java.nio.file.Path;
import java.nio.file.Paths;
import java.util.ArrayList;
import java.util.Arrays;
import java.util.List;
import java.util.zip.GZIPInputStream;

/** Recordings, and what the command makes of them. */
final class Recorded {
  static final Path ROOT = Paths.get(System.getProperty("lodemark.root", "../.."));

  private Recorded() {}

  /** Skips the test where the recording is absent. */
  static Path recording(String name) {
    String data = System.getenv("LODEMARK_DATA");
    Path folder = Paths.get(data == null ? System.getProperty("lodemark.recordings") : data, name);
    assumeTrue("no recording " + name, Files.isDirectory(folder));
    return folder;
  }

  static BufferedReader open(Path file) throws IOException {
    InputStream in = new FileInputStream(file.toFile());
    if (file.toString().endsWith(".gz"))
      in = new GZIPInputStream(in);
    return new BufferedReader(new InputStreamReader(in, StandardCharsets.UTF_8));
  }

  /** Runs the command, which must succeed; skips the test where it was not built. */
  static void command(String... arguments) throws IOException, InterruptedException {
    Path command = Paths.get(System.getProperty("lodemark.command", "none"));
    assumeTrue("the command lodemark was not built", Files.isExecutable(command));
    List<String> words = new ArrayList<>(Arrays.asList(command.toString()));
    words.addAll(Arrays.asList(arguments));
    File said = File.createTempFile("lodemark", ".log");
    Process process =
        new ProcessBuilder(words).redirectErrorStream(true).redirectOutput(said).start();
    int status = process.waitFor();
    assertEquals(String.join("\n", Files.readAllLines(said.toPath())), 0, status);
    Files.delete(said.toPath());
  }

  /** The rows of trajectory.csv that have a position, as replay finds them. */
  static List<String[]> replay(Path out, String... arguments)
      throws IOException, InterruptedException {
    List<String> words = new ArrayList<>(Arrays.asList("replay"));
    words.addAll(Arrays.asList(arguments));
    words.addAll(Arrays.asList("--out", out.toString()));
    command(words.toArray(new String[0]));
    List<String[]> rows = new ArrayList<>();
    for (String line : Files.readAllLines(out.resolve("trajectory.csv"))) {
      String[] cells = line.split(",", -1);
      if (!cells[1].isEmpty() && !cells[1].equals("latitude_deg"))
        rows.add(cells);
    }
    assertTrue("replay found no position", !rows.isEmpty());
    return rows;
  }
}
