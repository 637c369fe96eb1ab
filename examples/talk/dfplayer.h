/*
 * dfplayer.h - a DFPlayer Mini plays a file of its card: the command's bytes, for a serial line of 9,600 baud, 8 bits,
 * no parity, one stop bit, from the board's TX to the module's RX through a resistor of 1 kilohm.
 */
#ifndef EXAMPLE_DFPLAYER_H
#define EXAMPLE_DFPLAYER_H

#include <stdint.h>

#define DFPLAYER_BAUD 9600

/* From power-up until the module accepts commands: it reads its card first. Its manual says 1.5 to 3 s. */
#ifndef DFPLAYER_READY_MS
#define DFPLAYER_READY_MS 3000
#endif

/*
 * From the end of a command to the sound. The manual states 200 ms for preparing a file on the card. Modules with other
 * chips take up to half a second: if the jaw moves before the sound, increase it.
 */
#ifndef DFPLAYER_DELAY_MS
#define DFPLAYER_DELAY_MS 200
#endif

#define DFPLAYER_COMMAND_SIZE 10

/*
 * Command 0x0f: plays file `file` (1 .. 255) of folder `folder` (1 .. 99), which are called 01/001.wav and so on. The
 * checksum plus the bytes from the version (0xff) to the file's number is 2^16.
 */
static inline void dfplayer_play(uint8_t command[DFPLAYER_COMMAND_SIZE], uint8_t folder, uint8_t file)
{
    uint16_t checksum = 0;
    uint8_t i;
    command[0] = 0x7e; /* begin */
    command[1] = 0xff; /* version */
    command[2] = 6;    /* bytes from the version to the file's number */
    command[3] = 0x0f;
    command[4] = 0; /* no answer */
    command[5] = folder;
    command[6] = file;
    for (i = 1; i < 7; i++)
        checksum = (uint16_t)(checksum - command[i]);
    command[7] = (uint8_t)(checksum >> 8);
    command[8] = (uint8_t)(checksum & 0xff);
    command[9] = 0xef; /* end */
}

#endif
