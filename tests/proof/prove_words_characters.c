/*
 * Any bytes of a text of any size up to its largest here, at any place of it, after any number of characters.
 */
#include "prove.h"
#include "words_parts.h"

#define BYTES 64

int main(void)
{
    static unsigned char text[BYTES];
    labial_words_place_t here;
    FILL(text);
    FILL(here);
    here.text = text;
    here.size = (size_t)Frama_C_interval(0, BYTES);
    here.at = any_size;
    any_int = (int)labial_words_following(&here);
    labial_words_advance(&here);
    any_int = labial_words_is_capital(any_unsigned) + labial_words_is_latin(any_unsigned) +
              labial_words_is_decimal(any_unsigned) + labial_words_is_inside(any_unsigned);
    any_int = (int)labial_words_small_letter(any_unsigned);
    return 0;
}
