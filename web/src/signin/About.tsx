import type { ReactNode } from "react";
import { useTexts } from "../texts/TextsContext";
import { AboutDrawing } from "./AboutDrawing";

/** What Coaxial is, for a person who has never seen it. */
export function About(): ReactNode {
  const texts = useTexts().signIn.about;
  return (
    <div className="enter-about" data-testid="about">
      <h2>{texts.title}</h2>
      <AboutDrawing />
      {texts.sentences.map((sentence) => (
        <p key={sentence}>{sentence}</p>
      ))}
    </div>
  );
}
