/*
 * board.h - the functions of a board for firmware images: text, an exit status, an instruction counter, stack depth.
 *
 *     cmake --workflow --preset m0      builds every image for a board and runs it under QEMU; see boards/presets.json
 *
 * An image is a program with main(), made by the CMake function
 *
 *     labial_firmware(name main.c ...)                     then target_link_libraries(name PRIVATE labial::speech_en)
 *     add_test(NAME name COMMAND name)                     runs it under QEMU; it passes when main returns 0
 *
 * Images are freestanding: no C library, no heap; <stdint.h>, <stddef.h> and the few functions of <string.h> that
 * boards/include declares. RAM starts with the image's variables, the rest is stack: on m0 and rv32 there are 16 KB
 * together, on m0 flash ends at 256 KB; the link fails where an image does not fit. The same calls exist on the host,
 * where labial_firmware() makes an ordinary program; each call says what the host cannot measure.
 *
 * A processor fault ends the image with exit status 99, a stack that met the variables with 98.
 */
#ifndef BOARD_H
#define BOARD_H

#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* The board's name: that of its preset, or "host". */
extern const char board_name[];

/* ---- Text, to QEMU's standard output --------------------------------------------------------------------------- */

/* Lines are buffered until they end or fill 80 bytes; the remainder is written when the image ends. */
void board_put(char character);
void board_print(const char *text);
void board_print_unsigned(uint32_t number);
void board_print_signed(int32_t number);
void board_print_hex(uint32_t number); /* eight digits */

/* A number between two texts. */
void board_print_within(const char *before, uint32_t number, const char *behind);

/* Ends the image at once; main() returning a status does the same. */
void board_exit(int status);

/* ---- Instructions ------------------------------------------------------------------------------------------------ */

/* The longest stretch that can be counted on every board; 0 on the host, which has no counter. */
#define BOARD_COUNT_MAX 10000000u

/* The result of board_count() for a stretch that was too long. */
#define BOARD_COUNT_OVERFLOW UINT32_MAX

/*
 * Instructions from the return of board_count_start() to the call of board_count(), without those of either; 0 on the
 * host. QEMU runs with a fixed time per instruction, so that the board's own timers count instructions: exactly and
 * repeatably, to the instruction. A real board counts clock ticks by the same registers.
 */
void board_count_start(void);
uint32_t board_count(void);

/* ---- Interrupts, only on Arm boards ----------------------------------------------------------------------------- */

/* Interrupts that have a vector, and the number that the system timer has beside theirs; board_count_start() takes that
 * timer for itself. */
#define BOARD_INTERRUPTS 32
#define BOARD_SYSTEM_TIMER (0u - 1u)

/* Called for every interrupt that the image enables, with its number below BOARD_INTERRUPTS or that of the timer: an
 * image that uses interrupts defines it. Without a definition an interrupt is a processor fault. */
void board_interrupt(unsigned number);

/* ---- Stack ------------------------------------------------------------------------------------------------------- */

/* Fills the stack below its caller with a pattern; done once before main(). */
void board_stack_paint(void);

/* Bytes by which the stack grew below the caller of the last board_stack_paint(); 0 on the host, which cannot tell. */
uint32_t board_stack_depth(void);

/* Bytes of the stack that were never used since then; UINT32_MAX on the host. */
uint32_t board_stack_left(void);

#ifdef __cplusplus
}
#endif

#endif
