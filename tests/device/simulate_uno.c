/*
 * simulate_uno.c - runs an image for the ATmega328P of an Arduino Uno under simavr and prints what happens at its pins:
 *
 *     pin CYCLE LEVEL      pin 9 (OC1A) rose or fell
 *     serial CYCLE BYTE    a byte left by the serial port
 *
 *     simulate_uno IMAGE.elf MILLISECONDS [MILLISECONDS_OF_PRESS...]
 *
 * The button, pin 2 to ground, is pressed for 100 ms at each of the given times.
 */
#include <stdio.h>
#include <stdlib.h>

#include <simavr/avr_ioport.h>
#include <simavr/avr_timer.h>
#include <simavr/avr_uart.h>
#include <simavr/sim_avr.h>
#include <simavr/sim_elf.h>

#define CLOCK 16000000u
#define PRESS 100u /* milliseconds */

static avr_t *avr;
static avr_timer_t *timer;

static void on_pin(struct avr_irq_t *irq, uint32_t level, void *user)
{
    (void)irq;
    (void)user;
    printf("pin %llu %u\n", (unsigned long long)avr->cycle, (unsigned)level);
}

static void on_serial(struct avr_irq_t *irq, uint32_t byte, void *user)
{
    (void)irq;
    (void)user;
    printf("serial %llu %u\n", (unsigned long long)avr->cycle, (unsigned)byte);
}

/*
 * simavr 1.6 looks at the compare registers only when a timer's mode is written, so that a pulse would never change. A new
 * value counts from the next period on, as in the processor (ATmega328P data sheet, 16.9.3, fast PWM: the register is
 * double buffered), because simavr has the present period's compare already scheduled.
 */
static void on_compare_register(struct avr_irq_t *irq, uint32_t value, void *user)
{
    (void)irq;
    (void)user;
    timer->comp[AVR_TIMER_COMPA].comp_cycles = (value + 1u) * (timer->tov_cycles / (timer->tov_top + 1u));
}

static avr_timer_t *timer_1(void)
{
    avr_io_t *port;
    for (port = avr->io_port; port; port = port->next)
        if (port->irq && port->irq == avr_io_getirq(avr, AVR_IOCTL_TIMER_GETIRQ('1'), 0))
            return (avr_timer_t *)(void *)port;
    return NULL;
}

static int pressed(uint64_t milliseconds, char **times, int count)
{
    for (int i = 0; i < count; i++) {
        const uint64_t begin = strtoul(times[i], NULL, 10);
        if (milliseconds >= begin && milliseconds < begin + PRESS)
            return 1;
    }
    return 0;
}

int main(int argc, char **argv)
{
    elf_firmware_t image = { 0 };
    uint32_t flags = 0;
    int was_pressed = 0;
    if (argc < 3 || elf_read_firmware(argv[1], &image) != 0) {
        fprintf(stderr, "usage: simulate_uno IMAGE.elf MILLISECONDS [MILLISECONDS_OF_PRESS...]\n");
        return 2;
    }
    const uint64_t end = strtoull(argv[2], NULL, 10) * (CLOCK / 1000u);
    avr = avr_make_mcu_by_name("atmega328p");
    if (!avr)
        return 2;
    avr_init(avr);
    avr->frequency = CLOCK;
    avr_load_firmware(avr, &image);
    avr->frequency = CLOCK;
    timer = timer_1();
    if (!timer)
        return 2;
    avr_ioctl(avr, AVR_IOCTL_UART_GET_FLAGS('0'), &flags);
    flags &= ~(uint32_t)AVR_UART_FLAG_STDIO; /* the console says nothing */
    avr_ioctl(avr, AVR_IOCTL_UART_SET_FLAGS('0'), &flags);
    avr_irq_register_notify(avr_io_getirq(avr, AVR_IOCTL_IOPORT_GETIRQ('B'), 1), on_pin, NULL);
    avr_irq_register_notify(avr_io_getirq(avr, AVR_IOCTL_UART_GETIRQ('0'), UART_IRQ_OUTPUT), on_serial, NULL);
    avr_irq_register_notify(timer->io.irq + TIMER_IRQ_OUT_PWM0, on_compare_register, NULL);
    avr_raise_irq(avr_io_getirq(avr, AVR_IOCTL_IOPORT_GETIRQ('D'), 2), 1);
    while (avr->cycle < end) {
        const int state = avr_run(avr), now = pressed(avr->cycle / (CLOCK / 1000u), argv + 3, argc - 3);
        if (state == cpu_Done || state == cpu_Crashed) {
            fprintf(stderr, "the program ended or crashed\n");
            return 1;
        }
        if (now != was_pressed)
            avr_raise_irq(avr_io_getirq(avr, AVR_IOCTL_IOPORT_GETIRQ('D'), 2), !now);
        was_pressed = now;
    }
    return 0;
}
