/** What Labial.load() takes as `hearing`; programs call labial.hear(). */
export function hear(...given: any[]): Promise<unknown>;
