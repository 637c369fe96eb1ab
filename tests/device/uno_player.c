/*
 * uno_player.c - plays a track of two outputs into a port, or, without PLAYER, does the same without the player: what the
 * images differ by is the player. Nothing that it is given is a constant, so that the compiler can leave nothing out.
 */
#include <avr/io.h>

#include "labial_player.h"

static const uint8_t bytes[] LABIAL_PLAYER_FLASH = { 1, 2, 3, 4 };

static volatile uint16_t given = 2;
static volatile int32_t limit = 1900, shown;

int main(void)
{
#if defined(PLAYER)
    static labial_player_t player;
    const uint8_t *frame;
    labial_player_init(&player, bytes, given);
    while ((frame = labial_player_next(&player, given)) != NULL)
        shown = labial_player_value(frame, given, limit, limit);
#else
    while (given)
        shown = pgm_read_byte(bytes) + limit + limit;
#endif
    return 0;
}
