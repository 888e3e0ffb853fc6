import type { ReactNode } from "react";
import type { Cause } from "../live/assess";
import type { ProblemMessage } from "../live/messages";
import { useWords } from "../words/WordsContext";
import { Cover } from "./Cover";

interface VideoCoverProps {
  cause: Cause;
  /** What the server says is wrong, where it says so. */
  problem?: ProblemMessage | undefined;
}

/** Over the picture while there is none: why, in big words; calm while the page is loading. */
export function VideoCover({ cause, problem }: VideoCoverProps): ReactNode {
  const words = useWords();
  const { state, sentence } = words.cause[cause];
  if (cause === "connecting") return <Cover urgency="none" title={state} sentence={sentence} />;
  const said = problem === undefined ? sentence : `${problem.message}. ${problem.remedy}`;
  return <Cover urgency="medium" title={words.video.none} state={state} sentence={said} />;
}
