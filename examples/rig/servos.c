/*
 * servos.c - five servos on a PCA9685 (examples/faces/servos.toml). Prints the traffic on the I2C bus, one write to the
 * chip in each line: the register, then the bytes.
 *
 *     labial-rig-servos
 */
#include <stdio.h>

#include "labial/face.h"
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

/* Shows the first servos: those that are attached. The others' channels have no pulses yet. */
static void show(const int32_t *ticks, unsigned attached)
{
    uint8_t bytes[4 * SERVOS_OUTPUTS];
    for (unsigned i = 0; i < attached; i++) {
        bytes[4 * i] = bytes[4 * i + 1] = 0; /* pulses begin with the period */
        bytes[4 * i + 2] = (uint8_t)(ticks[i] & 0xff);
        bytes[4 * i + 3] = (uint8_t)(ticks[i] >> 8);
    }
    write_registers(LED0_ON_L, bytes, 4 * attached);
}

int main(void)
{
    static script_t script;
    static labial_face_t face;
    static int32_t room[LABIAL_FACE_SIZE(SERVOS_OUTPUTS, 0) / 4];
    int32_t ticks[SERVOS_OUTPUTS];
    write_register(MODE1, MODE1_SLEEP);
    write_register(PRESCALE, SERVOS_PCA9685_PRESCALE);
    write_register(MODE1, MODE1_INCREMENT); /* then waits 500 us for the oscillator */
    int moves = labial_face_init(&face, &servos, 50, 0, room, sizeof room);
    labial_face_soft_start(&face, 25); /* half a second for each servo to get to rest */
    for (int i = 0; moves >= 0 && i < 25 * SERVOS_OUTPUTS; i++) {
        moves = labial_face_tick(&face, ticks); /* and waits for the next 20 ms, here and below */
        show(ticks, labial_face_attached(&face));
    }
    int result = script_begin(&script, labial_face_frame, &face);
    while (result >= 0 && moves >= 0 && (result != LABIAL_DONE || moves != LABIAL_DONE)) {
        if (result != LABIAL_DONE)
            result = script_tick(&script);
        moves = labial_face_tick(&face, ticks);
        show(ticks, labial_face_attached(&face));
    }
    return result < 0 || moves < 0;
}
