/*
 * Servo.h - as much of the Arduino library Servo as the example sketches use.
 */
#ifndef ARDUINO_STUB_SERVO_H
#define ARDUINO_STUB_SERVO_H

#include <stdint.h>

class Servo
{
  public:
    uint8_t attach(int pin);
    void write(int angle);
    void writeMicroseconds(int pulse);
};

#endif
