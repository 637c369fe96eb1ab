/*
 * nrf51.h - the registers of the nRF51822 that the example uses, and where the micro:bit (version 1) has its pins.
 */
#ifndef EXAMPLE_NRF51_H
#define EXAMPLE_NRF51_H

#include <stdint.h>

#define NRF51_REGISTER(address) (*(volatile uint32_t *)(uintptr_t)(address))

/* The crystal, without which pulses are off by up to a percent. */
#define CLOCK_HFCLKSTART NRF51_REGISTER(0x40000000u)
#define CLOCK_HFCLKSTARTED NRF51_REGISTER(0x40000100u)

/* TIMER0 counts to 2^32, TIMER1 and TIMER2 to 2^16. */
#define TIMER0 0x40008000u
#define TIMER1 0x40009000u
#define TIMER1_INTERRUPT 9u

#define TIMER_START(timer) NRF51_REGISTER((timer) + 0x000u)
#define TIMER_CLEAR(timer) NRF51_REGISTER((timer) + 0x00cu)
#define TIMER_CAPTURE(timer, channel) NRF51_REGISTER((timer) + 0x040u + 4u * (channel))
#define TIMER_COMPARE(timer, channel) NRF51_REGISTER((timer) + 0x140u + 4u * (channel)) /* event */
#define TIMER_SHORTS(timer) NRF51_REGISTER((timer) + 0x200u)   /* bit n: compare n clears the timer */
#define TIMER_INTENSET(timer) NRF51_REGISTER((timer) + 0x304u) /* bit 16 + n: compare n interrupts */
#define TIMER_BITMODE(timer) NRF51_REGISTER((timer) + 0x508u)
#define TIMER_PRESCALER(timer) NRF51_REGISTER((timer) + 0x510u)
#define TIMER_CC(timer, channel) NRF51_REGISTER((timer) + 0x540u + 4u * (channel))

#define TIMER_BITMODE_16 0u
#define TIMER_BITMODE_32 3u
#define TIMER_PRESCALER_MICROSECONDS 4u /* 16 MHz / 2^4 */

#define GPIO_OUT NRF51_REGISTER(0x50000504u)
#define GPIO_OUTSET NRF51_REGISTER(0x50000508u)
#define GPIO_OUTCLR NRF51_REGISTER(0x5000050cu)
#define GPIO_IN NRF51_REGISTER(0x50000510u)
#define GPIO_DIRSET NRF51_REGISTER(0x50000518u)
#define GPIO_PIN_CNF(pin) NRF51_REGISTER(0x50000700u + 4u * (pin)) /* 0: input, connected, no pull */

#define NVIC_ISER NRF51_REGISTER(0xe000e100u)

/* The board's edge connector and its button A, which pulls its pin low. */
#define MICROBIT_P0 3u
#define MICROBIT_P1 2u
#define MICROBIT_P2 1u
#define MICROBIT_BUTTON_A 17u

#endif
