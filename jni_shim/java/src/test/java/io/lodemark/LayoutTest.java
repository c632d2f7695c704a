package io.lodemark;

import static org.junit.jupiter.api.Assertions.assertEquals;
import static org.junit.jupiter.api.Assertions.assertTrue;

import java.lang.reflect.Field;
import java.util.HashSet;
import java.util.LinkedHashMap;
import java.util.Map;
import java.util.Set;
import java.util.TreeSet;
import org.junit.jupiter.api.Test;

/** Every number that Java repeats of lodemark.h is the one that the compiler of the natives saw. */
class LayoutTest {
  private static final Map<String, Long> HEADER = readHeader();

  private static Map<String, Long> readHeader() {
    Map<String, Long> header = new LinkedHashMap<>();
    for (String line : Native.text(Native.layout()).split("\n")) {
      String[] words = line.split(" ");
      header.put(words[0], Long.valueOf(words[1]));
    }
    return header;
  }

  /** GnssClock to gnss_clock. */
  private static String nameOf(Class<?> type) {
    return type.getSimpleName().replaceAll("(?<=[a-z])(?=[A-Z])", "_").toLowerCase();
  }

  @Test
  void offsetsAreThoseOfTheCompiler() throws IllegalAccessException {
    Set<String> repeated = new TreeSet<>();
    for (Class<?> struct : Layout.class.getDeclaredClasses()) {
      for (Field field : struct.getDeclaredFields()) {
        if (field.getName().equals("SIZE"))
          continue;
        String name = nameOf(struct) + "." + field.getName().toLowerCase();
        assertEquals(HEADER.get(name), Long.valueOf(field.getInt(null)), name);
        repeated.add(name);
      }
    }
    Set<String> known = new TreeSet<>(HEADER.keySet());
    known.removeIf(name -> !name.contains("."));
    assertEquals(known, repeated);
  }

  @Test
  void sizesAreThoseOfTheHeaderOrOfAnOlderOne()
      throws IllegalAccessException, NoSuchFieldException {
    for (Class<?> struct : Layout.class.getDeclaredClasses()) {
      int size = struct.getDeclaredField("SIZE").getInt(null);
      assertTrue(size % 8 == 0 && size <= HEADER.get(nameOf(struct)), struct.getSimpleName());
      for (Field field : struct.getDeclaredFields()) assertTrue(field.getInt(null) <= size);
    }
  }

  @Test
  void constantsAreThoseOfTheHeader() throws IllegalAccessException {
    for (Field field : Values.class.getDeclaredFields()) {
      assertEquals(HEADER.get(field.getName()), Long.valueOf(field.getInt(null)), field.getName());
    }
  }

  @Test
  void enumsCountAsTheHeaderDoes() {
    checkEnum("OUTCOME_", Outcome.values());
    checkEnum("VERDICT_", Verdict.values());
    checkEnum("SYSTEM_", SatelliteSystem.values());
    checkEnum("TIME_BASE_", TimeBase.values());
    checkEnum("IONOSPHERE_", Ionosphere.values());
    checkEnum("TROPOSPHERE_", Troposphere.values());
    checkEnum("SCHEME_", Scheme.values());
    checkEnum("WEIGHT_", Weighting.values());
    checkEnum("PHOTO_", PhotoOutcome.values());
    checkEnum("EVENT_", SessionEvent.Kind.values());
    checkEnum("ESTIMATOR_", Estimator.values());
    checkEnum("POSE_", PoseVerdict.values());
  }

  private static void checkEnum(String prefix, Enum<?>[] values) {
    Set<String> names = new HashSet<>();
    for (Enum<?> value : values) {
      if (value.name().equals("UNKNOWN"))
        continue;
      names.add(prefix + value.name());
      assertEquals(
          HEADER.get(prefix + value.name()), Long.valueOf(value.ordinal()), prefix + value);
    }
    Set<String> known = new HashSet<>(HEADER.keySet());
    known.removeIf(name -> !name.startsWith(prefix));
    assertEquals(known, names);
  }

  @Test
  void statusesAreNamedAsInTheHeader() {
    for (LodemarkException.Status status : LodemarkException.Status.values()) {
      if (status == LodemarkException.Status.UNKNOWN)
        continue;
      int value = Math.toIntExact(HEADER.get("ERROR_" + status));
      assertEquals(status, LodemarkException.Status.of(value));
      assertEquals(status.name(), Native.text(Native.statusName(value)));
    }
    assertEquals(LodemarkException.Status.UNKNOWN, LodemarkException.Status.of(-77));
  }
}
