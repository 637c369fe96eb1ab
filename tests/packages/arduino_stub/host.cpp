/*
 * host.cpp - runs a sketch on a host: one call of loop() per millisecond of a made-up clock, for as many milliseconds
 * as the first argument says. Standard input is the serial line; what the sketch prints or writes to its servo goes to
 * standard output.
 */
#include <stdio.h>

#include "Arduino.h"
#include "Servo.h"

HardwareSerial Serial;
static unsigned long now = 0;
static int peeked = EOF;

unsigned long millis()
{
    return now;
}

void delay(unsigned long)
{
    fflush(stdout);
    exit(1); // the sketches wait only when something is wrong
}

void HardwareSerial::begin(unsigned long)
{
}

int HardwareSerial::available()
{
    if (peeked == EOF)
        peeked = getchar();
    return peeked != EOF;
}

int HardwareSerial::read()
{
    const int c = available() ? peeked : -1;
    peeked = EOF;
    return c;
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
    return (uint8_t)pin;
}

void Servo::write(int angle)
{
    printf("servo %d\n", angle);
}

int main(int argc, char **argv)
{
    const unsigned long end = argc > 1 ? strtoul(argv[1], NULL, 10) : 0;
    setup();
    for (now = 1; now < end; now++)
        loop();
    return 0;
}
