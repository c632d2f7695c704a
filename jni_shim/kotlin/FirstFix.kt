package sample

import io.lodemark.GnssLog
import io.lodemark.PositioningSession
import java.nio.file.Files
import java.nio.file.Path
import java.nio.file.Paths

/** Says where the phone of a recording was, second by second. */
fun positions(recording: Path): Sequence<String> = sequence {
  PositioningSession.open().use { session ->
    GnssLog.open(recording.resolve("gnss_log.txt")).use { log ->
      val orbits = recording.resolve("navigation.rnx")
      session.pushNavigation("navigation.rnx", Files.readAllBytes(orbits))
      while (log.pushNext(session)) {
        session.process()
        yield(session.estimate().toString())
      }
    }
  }
}

fun main(arguments: Array<String>) {
  positions(Paths.get(arguments[0])).forEach(::println) // such as sample_logs/walk
}
