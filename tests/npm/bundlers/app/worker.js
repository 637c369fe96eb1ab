import { frames } from "./lips.js";

frames(() => import("labial-laughter")).then(postMessage, (error) => postMessage(String(error)));
