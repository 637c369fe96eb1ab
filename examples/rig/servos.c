/*
 * servos.c - five servos on a PCA9685 (examples/faces/servos.toml). Prints the traffic on the I2C bus, one write to the
 * chip in each line: the register, then the bytes.
 *
 *     labial-rig-servos
 */
#include <stdio.h>

#include "script.h"
#include "servos.h"

/* Registers of the PCA9685. */
#define MODE1 0x00u
#define MODE1_INCREMENT 0x20u /* registers follow one another in a write */
#define MODE1_SLEEP 0x10u     /* the prescaler can only be set while the oscillator stands */
#define LED0_ON_L 0x06u       /* four registers per channel: on low, on high, off low, off high */
#define PRESCALE 0xfeu

/* Stands for a board's I2C driver. */
static void write_registers(unsigned first, const uint8_t *bytes, unsigned count)
{
    printf("%02x", first);
    for (unsigned i = 0; i < count; i++)
        printf(" %02x", bytes[i]);
    putchar('\n');
}

static void write_register(unsigned address, unsigned value)
{
    const uint8_t byte = (uint8_t)value;
    write_registers(address, &byte, 1);
}

static void on_frame(void *user, uint32_t frame, const int16_t faps[LABIAL_CHANNELS])
{
    int32_t *ticks = (int32_t *)user;
    uint8_t bytes[4 * SERVOS_OUTPUTS];
    (void)frame;
    labial_rig_apply(&servos, faps, ticks);
    for (unsigned i = 0; i < SERVOS_OUTPUTS; i++) {
        bytes[4 * i] = bytes[4 * i + 1] = 0; /* pulses begin with the period */
        bytes[4 * i + 2] = (uint8_t)(ticks[i] & 0xff);
        bytes[4 * i + 3] = (uint8_t)(ticks[i] >> 8);
    }
    write_registers(LED0_ON_L, bytes, sizeof bytes);
}

int main(void)
{
    static script_t script;
    int32_t ticks[SERVOS_OUTPUTS];
    write_register(MODE1, MODE1_SLEEP);
    write_register(PRESCALE, SERVOS_PCA9685_PRESCALE);
    write_register(MODE1, MODE1_INCREMENT); /* then waits 500 us for the oscillator */
    labial_rig_rest(&servos, ticks);
    int result = script_begin(&script, on_frame, ticks);
    while (result >= 0 && result != LABIAL_DONE)
        result = script_tick(&script); /* and waits for the next 20 ms */
    return result < 0;
}
