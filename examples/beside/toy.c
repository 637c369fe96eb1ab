/*
 * toy.c - a toy on a PC, for server.py: the loudspeaker is simulated, and the servos are lines on the screen.
 *
 *     cc -std=c99 -Iinclude examples/beside/toy.c lib/beside.c -o toy
 *     printf 'say Mama may pop.\nplay 9000\n' | ./toy 8765
 *
 * Standard input has a command in each line: "say TEXT" and "stop" go to the server, with "stop" the toy drops the
 * sound that it has not played; "play MS" lets time pass, at most until everything has been heard, as fast as the
 * server sends. Options behind the port: "lose N" loses every Nth packet of lips, "jitter" makes the loudspeaker's
 * clock uneven. Without a server, or when it goes or falls silent, it says so and ends with status 1.
 *
 * A line of output is 20 ms: the number of the sample that is heard, 1 if the mouth speaks, the packet's bytes, and the
 * servos' pulses in microseconds.
 */
#define _POSIX_C_SOURCE 200809L

#include <arpa/inet.h>
#include <errno.h>
#include <netinet/in.h>
#include <signal.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <sys/time.h>

#include "labial/beside.h"

#define OUTPUTS 2 /* of face.toml */
#define FRAMES 64 /* more than the sound that waits here */
#define WAITS 500 /* milliseconds of sound that are taken before they are played */

#ifndef PATIENCE
#define PATIENCE 20 /* seconds in which a server that is asked for something sends it */
#endif

/* Pulses of the servos for the bytes 0 and 255, to be found by trial, and the largest changes in 20 ms that they
 * follow: `slew` of face.toml. */
static const int32_t at_0[OUTPUTS] = { 1400, 1300 }, at_255[OUTPUTS] = { 1900, 1700 };
static const uint8_t limits[OUTPUTS] = { LABIAL_BESIDE_CHANGE(100, 1400, 1900), LABIAL_BESIDE_CHANGE(80, 1300, 1700) };

static labial_beside_t lips;
static uint8_t memory[LABIAL_BESIDE_SIZE(OUTPUTS, FRAMES)];
static FILE *server;
static uint32_t rate, received, heard; /* samples since the beginning */
static int speaks;                     /* utterances whose sound is still to come */
static int cancelling;                 /* sound is dropped until the server has heard of it */
static unsigned lose, packets, jitter;

/* Ends the program: "toy: WHAT: WHY". What was shown so far is on the screen. */
static void fail(const char *what, const char *why)
{
    fflush(stdout);
    fprintf(stderr, "toy: %s: %s\n", what, why);
    exit(1);
}

static void take(uint8_t *data, size_t size)
{
    if (fread(data, 1, size, server) == size)
        return;
    if (feof(server))
        fail("the server has gone", "it closed the connection");
    fail("the server has gone", errno == EAGAIN || errno == EWOULDBLOCK ? "it sends nothing" : strerror(errno));
}

static void give(const char *line)
{
    if (dprintf(fileno(server), "%s", line) < 0)
        fail("the server has gone", strerror(errno));
}

/* Connects to a port of this computer. */
static void connect_to(unsigned port)
{
    const struct timeval patience = { .tv_sec = PATIENCE };
    const struct sockaddr_in to = { .sin_family = AF_INET,
                                    .sin_port = htons((uint16_t)port),
                                    .sin_addr.s_addr = htonl(INADDR_LOOPBACK) };
    const int connection = socket(AF_INET, SOCK_STREAM, 0);
    char where[16];
    (void)snprintf(where, sizeof where, "port %u", port);
    signal(SIGPIPE, SIG_IGN);
    if (connection < 0 || setsockopt(connection, SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof patience) != 0 ||
        connect(connection, (const struct sockaddr *)&to, sizeof to) != 0 || !(server = fdopen(connection, "r")))
        fail(where, strerror(errno));
}

/* The next message. What is in it is trusted as little as what is in a packet of lips. */
static void take_message(void)
{
    static uint8_t data[65536];
    uint8_t head[3];
    size_t size;
    take(head, sizeof head);
    size = head[1] | (size_t)head[2] << 8;
    take(data, size);
    if (head[0] == 'R' && size == 4 && rate == 0) {
        rate = data[0] | (uint32_t)data[1] << 8 | (uint32_t)data[2] << 16 | (uint32_t)data[3] << 24;
        if (rate < 8000 || rate > 48000 || labial_beside_init(&lips, OUTPUTS, rate, memory, sizeof memory) != LABIAL_OK)
            fail("the server", "it sends sound of an unknown rate");
        for (unsigned i = 0; i < OUTPUTS; i++)
            (void)labial_beside_limit(&lips, i, limits[i]);
    } else if (head[0] == 'A') {
        received += (uint32_t)(size / 2); /* also of sound that is dropped */
        if (cancelling)
            heard = received;
    } else if (head[0] == 'E') {
        speaks -= !cancelling && speaks > 0;
    } else if (head[0] == 'L' && (lose == 0 || ++packets % lose != 0)) {
        if (labial_beside_push(&lips, data, size) == LABIAL_CANCELLED) {
            heard = received;
            cancelling = 0;
        }
    }
}

static void show(void)
{
    static uint32_t seed = 1;
    uint8_t values[OUTPUTS];
    uint32_t sample = heard;
    int result, i;
    if (jitter) {
        seed = seed * 1664525u + 1013904223u;
        sample += (seed >> 16) % (rate / 50) - rate / 100; /* up to 10 ms to either side */
    }
    result = labial_beside_tick(&lips, sample, values);
    if (result < 0)
        return;
    printf("%lu %d", (unsigned long)sample, result == LABIAL_OK);
    for (i = 0; i < OUTPUTS; i++)
        printf(" %d", values[i]);
    for (i = 0; i < OUTPUTS; i++)
        printf(" %ld", (long)labial_beside_value(values[i], at_0[i], at_255[i]));
    putchar('\n');
}

/* Lets 20 ms pass: sound comes in while there is room, and as much is heard, if there is as much. */
static void pass(void)
{
    while ((speaks || cancelling) && (received - heard < rate / 1000 * WAITS || cancelling))
        take_message();
    show();
    heard += received - heard < rate / 50 ? received - heard : rate / 50;
}

/* A whole number from 1 to `most`; 0 for any other text. */
static unsigned number(const char *text, unsigned long most)
{
    char *end;
    const unsigned long value = strtoul(text, &end, 10);
    return *text >= '0' && *text <= '9' && *end == '\0' && value <= most ? (unsigned)value : 0;
}

int main(int argc, char **argv)
{
    static const char usage[] = "usage: toy PORT [lose N] [jitter]\n";
    unsigned port = argc > 1 ? number(argv[1], 65535) : 0;
    char line[1024];
    int i;
    for (i = 2; i < argc; i++) {
        if (strcmp(argv[i], "jitter") == 0)
            jitter = 1;
        else if (strcmp(argv[i], "lose") != 0 || i + 1 == argc || (lose = number(argv[++i], 1000000)) == 0)
            port = 0;
    }
    if (port == 0) {
        fputs(usage, stderr);
        return 2;
    }
    (void)setvbuf(stdout, NULL, _IOLBF, BUFSIZ); /* a line is seen when it is shown */
    connect_to(port);
    while (rate == 0)
        take_message();
    while (fgets(line, sizeof line, stdin)) {
        if (!strchr(line, '\n') && strlen(line) == sizeof line - 1)
            fail("standard input", "a line is too long");
        if (strncmp(line, "play ", 5) == 0) {
            unsigned long left = strtoul(line + 5, NULL, 10) / 20;
            while (left-- > 0 && (speaks || received != heard))
                pass();
        } else if (strncmp(line, "say ", 4) == 0) {
            give(line);
            speaks++;
        } else if (strncmp(line, "stop", 4) == 0) {
            give(line);
            speaks = 0;
            cancelling = 1; /* the loudspeaker falls silent now, and the mouth closes */
            labial_beside_cancel(&lips, 20u * LABIAL_BESIDE_EASE);
            for (i = 0; i < LABIAL_BESIDE_EASE; i++)
                show();
        } else {
            fail("standard input", "a line is neither say TEXT, play MS nor stop");
        }
    }
    for (i = 0; i <= LABIAL_BESIDE_HOLD + LABIAL_BESIDE_EASE; i++)
        show();
    return 0;
}
