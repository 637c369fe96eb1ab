/*
 * host.cpp - runs a sketch on a host: one call of loop() per millisecond of a made-up clock, for as many milliseconds
 * as the first argument says; at the time that the second one says, if there is one, each button is pressed for 100 ms.
 * Standard input is the serial line: all of it is there at once, or, with a third argument, it comes at 115,200 baud into
 * a buffer of so many bytes, and what finds no place there is lost. What the sketch prints, or does with what is connected, goes to standard output.
 */
#include <stdio.h>
#include <string.h>

#include "Arduino.h"
#include "Avatar.h"
#include "M5Unified.h"
#include "Servo.h"
#include "Wire.h"

HardwareSerial Serial, Serial2;
TwoWire Wire;
m5::M5Unified M5;
static unsigned long now = 0, end = 0, press = 0;
static int peeked = EOF;
static char buffer[256];
static size_t buffered = 0, buffer_size = 0;

static bool pressed()
{
    return press > 0 && now >= press && now < press + 100;
}

unsigned long millis()
{
    return now;
}

void delay(unsigned long milliseconds)
{
    now += milliseconds;
    if (now >= end) {
        fflush(stdout);
        exit(1); // where something is wrong the sketches wait for ever
    }
}

void pinMode(uint8_t, uint8_t)
{
}

int digitalRead(uint8_t)
{
    return pressed() ? LOW : HIGH;
}

void HardwareSerial::begin(unsigned long)
{
}

void HardwareSerial::begin(unsigned long, uint32_t, int, int)
{
}

/* Moves what has come by now into the buffer. */
static void receive()
{
    static unsigned long received = 0;
    for (; received < now * 1152 / 100; received++) {
        const int c = getchar();
        if (c != EOF && buffered < buffer_size)
            buffer[buffered++] = (char)c;
    }
}

int HardwareSerial::available()
{
    if (buffer_size > 0) {
        receive();
        return (int)buffered;
    }
    if (peeked == EOF)
        peeked = getchar();
    return peeked != EOF;
}

int HardwareSerial::read()
{
    int c = -1;
    if (available() == 0)
        return c;
    if (buffer_size > 0) {
        c = buffer[0];
        memmove(buffer, buffer + 1, --buffered);
    } else {
        c = peeked;
        peeked = EOF;
    }
    return c;
}

size_t HardwareSerial::write(const uint8_t *bytes, size_t count)
{
    printf("serial %lu", now);
    for (size_t i = 0; i < count; i++)
        printf(" %02x", (unsigned)bytes[i]);
    puts("");
    return count;
}

void HardwareSerial::print(const char *text)
{
    fputs(text, stdout);
}

void HardwareSerial::print(int value)
{
    printf("%d", value);
}

void HardwareSerial::println(const char *text)
{
    puts(text);
}

void HardwareSerial::println(int value)
{
    printf("%d\n", value);
}

uint8_t Servo::attach(int pin)
{
    printf("attach %lu %d\n", now, pin);
    return (uint8_t)pin;
}

void Servo::write(int angle)
{
    printf("servo %lu %d\n", now, angle);
}

void Servo::writeMicroseconds(int pulse)
{
    printf("pulse %lu %d\n", now, pulse);
}

bool TwoWire::begin(int, int, uint32_t)
{
    return true;
}

void TwoWire::beginTransmission(uint8_t address)
{
    printf("wire %lu %02x", now, (unsigned)address);
}

size_t TwoWire::write(uint8_t byte)
{
    printf(" %02x", (unsigned)byte);
    return 1;
}

uint8_t TwoWire::endTransmission()
{
    puts("");
    return 0;
}

bool m5::Button_Class::wasPressed() const
{
    return press > 0 && now == press;
}

void m5::M5Unified::begin()
{
}

void m5::M5Unified::update()
{
}

void m5avatar::Avatar::init()
{
}

void m5avatar::Avatar::setMouthOpenRatio(float ratio)
{
    printf("mouth %lu %.3f\n", now, (double)ratio);
}

int main(int argc, char **argv)
{
    end = argc > 1 ? strtoul(argv[1], NULL, 10) : 0;
    press = argc > 2 ? strtoul(argv[2], NULL, 10) : 0;
    buffer_size = argc > 3 ? strtoul(argv[3], NULL, 10) % sizeof buffer : 0;
    setup();
    for (now++; now < end; now++)
        loop();
    return 0;
}
