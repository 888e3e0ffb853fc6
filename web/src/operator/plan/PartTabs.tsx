import type { ReactNode } from "react";
import { useTexts } from "../../texts/TextsContext";
import { usePlanning } from "./state/PlanContext";
import { PARTS, useWork, type Part } from "./state/WorkContext";

/** Tabs of the parts of the plan, with their content. */
export function PartTabs(): ReactNode {
  const texts = useTexts().plan;
  const { part, setPart } = useWork();
  const { plan, vertebra } = usePlanning();
  const active = plan?.active_channel ?? null;
  const there: Record<Part, string> = {
    ct: "✓",
    pedicle: counted(vertebra?.pedicles.length),
    channel: counted(vertebra?.channels.length) + (active === null ? "" : " ●"),
    lines: vertebra?.references.length ? "✓" : "",
    landmarks: counted(vertebra?.landmarks.length),
    surface: "",
    file: "",
  };
  return (
    <nav className="part-tabs" aria-label={texts.parts}>
      {PARTS.map((one) => (
        <button
          key={one}
          type="button"
          aria-current={one === part ? "page" : undefined}
          data-testid={`part-${one}`}
          onClick={() => {
            setPart(one);
          }}
        >
          {texts.part[one]}
          {there[one] !== "" && <span className="part-there"> {there[one]}</span>}
        </button>
      ))}
    </nav>
  );
}

function counted(count: number | undefined): string {
  return count === undefined || count === 0 ? "" : String(count);
}
