/** A model of hearing, as `model` of labial.hear() takes it. */
declare const model: string;
export default model;
