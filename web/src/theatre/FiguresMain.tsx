import type { ReactNode } from "react";
import { ConfirmRestart } from "../app/ConfirmRestart";
import { AfterFirstMessage } from "../live/AfterFirstMessage";
import { LoadingNumbers } from "../panes/LoadingNumbers";
import { Moves } from "../panes/Moves";
import { NumbersPane } from "../panes/NumbersPane";

/** The headline and the figures alone, as large as the screen allows. */
export function FiguresMain(): ReactNode {
  return (
    <main className="theatre-main">
      <AfterFirstMessage loading={<LoadingNumbers />}>
        <NumbersPane beside={<Moves />} over={<ConfirmRestart />} />
      </AfterFirstMessage>
    </main>
  );
}
