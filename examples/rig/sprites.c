/*
 * sprites.c - a drawn mouth of twelve pictures: each frame shows the picture that is nearest to its shape. Writes an
 * animation to look at in a browser, the twelve pictures below it.
 *
 *     labial-rig-sprites > mouth.svg
 */
#include <stdio.h>

#include "script.h"
#include "sprites.h"

#define PICTURES 12
#define FRAMES_MAX 1024
#define WIDTH 120 /* of a picture */

/* The features of each picture, in the order of examples/faces/sprites.toml. */
static const struct {
    const char *name;
    int16_t features[SPRITES_OUTPUTS]; /* opening, smile, rounding, upper lip */
} pictures[PICTURES] = {
    { "rest", { 0, 0, 0, 0 } },         { "p b m", { 50, 60, 30, -140 } },   { "f v", { 80, 50, 100, 20 } },
    { "parted", { 150, 20, 40, -10 } }, { "small", { 240, 0, 80, 0 } },      { "eh", { 340, 90, 0, 80 } },
    { "open", { 450, 20, 60, 70 } },    { "wide open", { 580, 90, 0, 80 } }, { "w", { 220, -70, 170, -50 } },
    { "oh", { 240, -170, 380, -80 } },  { "smile", { 20, 260, -100, 50 } },  { "laugh", { 150, 310, -100, 80 } },
};

static uint32_t distance(const int32_t features[SPRITES_OUTPUTS], unsigned picture)
{
    uint32_t sum = 0;
    for (unsigned i = 0; i < SPRITES_OUTPUTS; i++) {
        const int32_t difference = features[i] - pictures[picture].features[i];
        sum += (uint32_t)(difference * difference); /* the rig's limits keep it below 2^21 */
    }
    return sum;
}

typedef struct {
    int32_t features[SPRITES_OUTPUTS];
    unsigned picture; /* that is shown */
    unsigned held;    /* frames for which it has been */
    uint8_t shown[FRAMES_MAX];
    unsigned count;
} film_t;

/* Chooses the picture for the film's features. Two rules keep the mouth from flickering: a picture stays for at least
 * two frames, and is replaced only by one that is clearly nearer, by a fifth of the distance. */
static void choose(film_t *film)
{
    unsigned nearest = 0;
    for (unsigned i = 1; i < PICTURES; i++)
        if (distance(film->features, i) < distance(film->features, nearest))
            nearest = i;
    film->held++;
    if (film->held > 2 && 25u * distance(film->features, nearest) < 16u * distance(film->features, film->picture)) {
        film->picture = nearest;
        film->held = 1;
    }
}

static void on_frame(void *user, uint32_t frame, const int16_t faps[LABIAL_CHANNELS])
{
    film_t *film = (film_t *)user;
    labial_rig_apply(&sprites, faps, film->features);
    if (frame < FRAMES_MAX) {
        choose(film);
        film->shown[frame] = (uint8_t)film->picture;
        film->count = frame + 1;
    }
}

/* Two curves from corner to corner that pass through `top` and `bottom` in the middle. */
static void draw_curves(int centre, int half, int corner, int top, int bottom, const char *style)
{
    printf("<path d='M%d %dQ%d %d %d %dQ%d %d %d %dZ' %s/>\n", centre - half, corner, centre, 2 * top - corner,
           centre + half, corner, centre, 2 * bottom - corner, centre - half, corner, style);
}

/* A mouth, drawn from the picture's own features in tenths of a unit: lips around the opening, and the upper teeth
 * where it is not round. Lips at rest press on each other, so that the first of the opening is not seen. */
static void draw(unsigned picture)
{
    const int16_t *f = pictures[picture].features;
    const int centre = (int)picture * 10 * WIDTH + 5 * WIDTH, half = 330 + f[1] / 3 - f[2] / 2;
    const int opening = f[0] > 60 ? f[0] - 60 : 0, top = 450 - f[3] / 3, corner = top + opening / 3 - f[1] / 4;
    const int lip = 60 + f[2] / 10 + (f[3] < 0 ? f[3] / 6 : 0);
    char style[128];
    snprintf(style, sizeof style,
             "fill='#5b1320' stroke='#c2485b' stroke-width='%d' stroke-linejoin='round' paint-order='stroke'", 2 * lip);
    draw_curves(centre, half, corner, top, top + opening, style);
    if (f[2] < 150)
        draw_curves(centre, half, corner, top, top + (opening < 200 ? opening / 2 : 100), "fill='#fff'");
    printf("<text x='%d' y='1330' text-anchor='middle' font-size='130' font-family='sans-serif'>%s</text>\n", centre,
           pictures[picture].name);
}

static void write_svg(const film_t *film)
{
    printf("<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 720 480'>\n<defs><g id='strip' "
           "transform='scale(.1)'>\n");
    for (unsigned i = 0; i < PICTURES; i++)
        draw(i);
    printf("</g></defs>\n<svg x='240' width='240' height='240' viewBox='0 0 120 120'><g><use href='#strip'/>\n"
           "<animateTransform attributeName='transform' type='translate' calcMode='discrete' "
           "repeatCount='indefinite' dur='%ums' values='",
           film->count * 20u);
    for (unsigned i = 0; i < film->count; i++)
        printf("%s%d", i > 0 ? ";" : "", -WIDTH * film->shown[i]);
    printf("'/></g></svg>\n");
    for (unsigned i = 0; i < 2; i++)
        printf("<svg x='0' y='%u' width='720' height='140' viewBox='%u 0 720 140'><use href='#strip'/></svg>\n",
               240u + 120u * i, 720u * i);
    printf("</svg>\n");
}

int main(void)
{
    static script_t script;
    static film_t film;
    labial_rig_rest(&sprites, film.features);
    int result = script_begin(&script, on_frame, &film);
    while (result >= 0 && result != LABIAL_DONE)
        result = script_tick(&script);
    if (result >= 0)
        write_svg(&film);
    return result < 0;
}
