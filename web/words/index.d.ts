/** What Labial.load() takes as `words`; programs call labial.words(). */
export function words(...given: any[]): Promise<unknown>;
