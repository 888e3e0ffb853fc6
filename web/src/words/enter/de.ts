import type { EnterWords } from "./en";

export const enterDe: EnterWords = {
  needed:
    "Melden Sie sich mit dem Link an, den der Server beim Start ausgegeben hat, oder mit einer Einladung.",
};
