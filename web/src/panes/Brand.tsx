import type { ReactNode } from "react";
import { useTexts } from "../texts/TextsContext";

/** Product name, and the notice that it is not a medical device. */
export function Brand(): ReactNode {
  const texts = useTexts();
  return (
    <div className="brand">
      <img src="/coaxial.svg" alt="" width={44} height={44} />
      <div>
        <h1>{texts.product}</h1>
        <p className="notice">{texts.notice}</p>
      </div>
    </div>
  );
}
