package io.lodemark.android;

import static org.junit.Assert.assertEquals;
import static org.junit.Assert.assertTrue;

import android.app.Activity;
import android.graphics.Bitmap;
import android.graphics.Canvas;
import android.location.GnssMeasurementsEvent;
import android.os.Looper;
import android.view.View;
import android.view.ViewGroup;
import android.widget.TextView;
import io.lodemark.sample.MainActivity;
import io.lodemark.sample.SkyView;
import java.nio.file.Files;
import java.nio.file.Path;
import java.util.ArrayList;
import java.util.List;
import org.junit.Test;
import org.junit.runner.RunWith;
import org.robolectric.Robolectric;
import org.robolectric.RobolectricTestRunner;
import org.robolectric.Shadows;
import org.robolectric.android.controller.ActivityController;
import org.robolectric.annotation.Config;

/** The sample app's screen, with the walk's satellites in the sky. */
@RunWith(RobolectricTestRunner.class)
@Config(sdk = 34, manifest = Config.NONE)
public class SampleAppTest {
  private static final Path WALK = Recorded.ROOT.resolve("sample_logs/walk");

  @Test
  public void itShowsFixAndSky() throws Exception {
    Path files = Phone.app().getFilesDir().toPath();
    Files.createDirectories(files);
    Files.copy(WALK.resolve("navigation.rnx"), files.resolve("navigation.rnx"));
    List<GnssMeasurementsEvent> events = new ArrayList<>();
    LoggedEvents.read(WALK.resolve("gnss_log.txt"), events::add, message -> {});

    ActivityController<MainActivity> app = Robolectric.buildActivity(MainActivity.class).create();
    ViewGroup screen = screenOf(app.get());
    SkyView sky = (SkyView) screen.getChildAt(0);
    TextView text = (TextView) screen.getChildAt(1);
    app.start();
    Shadows.shadowOf(Looper.getMainLooper()).idle();
    assertTrue(text.getText().toString(), text.getText().toString().contains("requestPermissions"));

    Phone.allow();
    app.get().onRequestPermissionsResult(1, new String[0], new int[0]);
    for (int i = 0; i < 3; ++i)
      Shadows.shadowOf(Phone.location()).simulateGnssMeasurementsEvent(events.get(i));
    app.stop(); // what waits is processed first
    Shadows.shadowOf(Looper.getMainLooper()).idle();
    assertTrue(text.getText().toString(), text.getText().toString().startsWith("30.528"));
    assertTrue("satellites in the sky: " + sky.count(), sky.count() > 20);
    sky.layout(0, 0, 400, 300);
    sky.draw(new Canvas(Bitmap.createBitmap(400, 300, Bitmap.Config.ARGB_8888)));
    app.destroy();
  }

  private static ViewGroup screenOf(Activity activity) {
    ViewGroup content = activity.findViewById(android.R.id.content);
    View screen = content.getChildAt(0);
    assertEquals(2, ((ViewGroup) screen).getChildCount());
    return (ViewGroup) screen;
  }
}
