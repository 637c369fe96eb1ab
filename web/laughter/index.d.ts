/** The laughter model, as Labial.load() takes it. */
declare const laughter: string;
export default laughter;
