/** What frameworks set on an element, and its events. */
export type Settings<E> = Partial<Pick<E, keyof E & ("audio" | "track" | "stream" | "hearing" | "voice" | "words" | "caption")>> & {
    onended?: (event: Event) => void;
    onlost?: (event: Event) => void;
};
