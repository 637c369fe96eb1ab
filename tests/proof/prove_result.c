/* Any number. */
#include "labial/labial.h"

#include "prove.h"

int main(void)
{
    return labial_result_text(any_int)[0];
}
