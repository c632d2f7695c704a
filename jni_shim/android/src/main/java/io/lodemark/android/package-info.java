/**
 * A phone's sensors for {@link io.lodemark.PositioningSession}: {@link
 * io.lodemark.android.SensorFeed} takes what Android's framework gives, {@link
 * io.lodemark.android.GnssLogWriter} records it so that {@code lodemark replay} finds the same
 * places on a desktop. From Android 10 (API 29) on; nothing but the framework is needed.
 */
package io.lodemark.android;
