import type { ReactNode } from "react";

export type Mood = "good" | "waiting" | "bad" | "plain";
const SYMBOL: Record<Mood, string> = { good: "●", waiting: "◌", bad: "▲▲", plain: "" };

interface FactProps {
  name: string;
  value: string;
  mood?: Mood;
  testid?: string;
}

/** A name with its value. A mood has a shape besides its colour. */
export function Fact({ name, value, mood = "plain", testid }: FactProps): ReactNode {
  return (
    <div className="fact" data-mood={mood} data-testid={testid}>
      <dt>{name}</dt>
      <dd title={value}>
        {mood !== "plain" && (
          <span aria-hidden="true" className="marks">
            {SYMBOL[mood]}{" "}
          </span>
        )}
        {value}
      </dd>
    </div>
  );
}
