import type { ReactNode } from "react";
import type { Cause } from "../live/assess";
import type { TroubleMessage } from "../live/messages";
import { useWords } from "../words/WordsContext";
import { Cover } from "./Cover";

interface VideoCoverProps {
  cause: Cause;
  /** What the server says is wrong, where it says so. */
  trouble?: TroubleMessage | undefined;
}

/** Over the picture while there is none: why, in big words; calm while the page is loading. */
export function VideoCover({ cause, trouble }: VideoCoverProps): ReactNode {
  const words = useWords();
  const { state, sentence } = words.cause[cause];
  if (cause === "connecting") return <Cover urgency="none" title={state} sentence={sentence} />;
  const said = trouble === undefined ? sentence : `${trouble.message}. ${trouble.remedy}`;
  return <Cover urgency="medium" title={words.video.none} state={state} sentence={said} />;
}
