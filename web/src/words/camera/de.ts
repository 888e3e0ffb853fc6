import type { CameraWords } from "./en";

export const cameraDe: CameraWords = { title: "Kamera" };
