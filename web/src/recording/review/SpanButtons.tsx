import { Button } from "@mantine/core";
import type { ReactNode } from "react";
import { useTexts } from "../../texts/TextsContext";
import { clampSpan, moveSpan, zoomSpan, type Span } from "./span";

interface SpanButtonsProps {
  span: Span;
  atS: number;
  durationS: number;
  onSpan: (span: Span) => void;
}

/** Buttons that move and scale the visible span. */
export function SpanButtons({ span, atS, durationS, onSpan }: SpanButtonsProps): ReactNode {
  const own = useTexts().recording.review;
  const buttons: [label: string, symbol: string, testId: string, to: () => Span][] = [
    [own.earlier, "←", "review-earlier", () => moveSpan(span, -0.5, durationS)],
    [own.zoomOut, "−", "review-zoom-out", () => zoomSpan(span, 0.5, atS, durationS)],
    [own.zoomIn, "+", "review-zoom-in", () => zoomSpan(span, 2, atS, durationS)],
    [own.later, "→", "review-later", () => moveSpan(span, 0.5, durationS)],
    [own.whole, own.whole, "review-whole", () => ({ fromS: 0, toS: durationS })],
  ];
  return (
    <div className="review-zoom">
      {buttons.map(([label, symbol, testId, to]) => (
        <Button
          key={testId}
          size="lg"
          variant="default"
          aria-label={label}
          data-testid={testId}
          onClick={() => {
            onSpan(clampSpan(to(), durationS));
          }}
        >
          {symbol}
        </Button>
      ))}
      <span className="soft">{own.gestures}</span>
    </div>
  );
}
