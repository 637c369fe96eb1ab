/*
 * servo.h - the jaw: one servo that follows lips_frame() (lips.h), on an ESP32 with ESP-IDF or Arduino.
 */
#ifndef SERVO_H
#define SERVO_H

#ifdef __cplusplus
extern "C" {
#endif

/* Pulses in microseconds: mouth closed and wide open. Find yours before you connect the linkage (docs/servos.md). */
#ifndef SERVO_CLOSED
#define SERVO_CLOSED 1400
#endif
#ifndef SERVO_OPEN
#define SERVO_OPEN 1900
#endif

/* Microseconds by which a pulse changes at most in 20 ms: what a common servo can follow. */
#ifndef SERVO_SLEW
#define SERVO_SLEW 160
#endif

/* Moves the servo on a pin every 20 ms from now on. Returns 0, or an error of ESP-IDF. */
int servo_begin(int pin);

#ifdef __cplusplus
}
#endif

#endif
