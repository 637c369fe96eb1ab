// What the page speaks: espeak-ng's names of voices, and the first part of their data's names. Add a row, and build.

export const LANGUAGES = [
    { voice: "en-us", data: "en", name: "English", text: "Papa may be by the sea, but mama bakes a big apple pie." },
    { voice: "de", data: "de", name: "Deutsch", text: "Papa mag am Abend bei Mama ein paar Pflaumen probieren." },
    { voice: "es", data: "es", name: "Español", text: "Papá compra pan y miel para mamá en el bonito pueblo." },
    { voice: "fr", data: "fr", name: "Français", text: "Papa apporte un beau bouquet de pivoines à maman." },
    { voice: "it", data: "it", name: "Italiano", text: "Il babbo prepara un piatto di pasta per la mamma." },
    { voice: "hi", data: "hi", name: "हिन्दी", text: "मेरी माँ बाज़ार में पके आम और पपीता बेचती है।" },
];
