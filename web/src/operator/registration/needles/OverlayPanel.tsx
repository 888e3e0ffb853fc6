import { Button, SegmentedControl, Slider } from "@mantine/core";
import { useState, type ReactNode } from "react";
import { formatNumber } from "../../../live/rounding";
import { Icon } from "../../../panes/Icon";
import { useTexts } from "../../../texts/TextsContext";
import { ConcludeNeedles } from "./ConcludeNeedles";
import type { NeedleRequest } from "./order";
import { fadeOverlay, translateOverlay, placeOf, scaleOverlay, rotateOverlay, type Overlay } from "./overlay";
import type { OverlayState, OverlayController } from "./overlayController";

const STEPS = {
  fine: { px: 1, deg: 0.25, ratio: 1.0025 },
  coarse: { px: 10, deg: 2, ratio: 1.02 },
} as const;

interface OverlayPanelProps {
  controller: OverlayController;
  state: OverlayState;
  order: NeedleRequest;
  isFrozen: boolean;
  onRelease: () => void;
}

/** Fine steps for the overlay: move, rotate, scale; opacity, undo, and register. */
export function OverlayPanel({
  controller,
  state,
  order,
  isFrozen,
  onRelease,
}: OverlayPanelProps): ReactNode {
  const texts = useTexts().registration.overlay;
  const [size, setSize] = useState<keyof typeof STEPS>("coarse");
  const step = STEPS[size];
  const turn = (deg: number) => (hand: Overlay) => rotateOverlay(hand, deg, placeOf(hand));
  const grow = (ratio: number) => (hand: Overlay) => scaleOverlay(hand, ratio, placeOf(hand));
  const pad: [ReactNode, string, (hand: Overlay) => Overlay][] = [
    [<Icon key="left" name="turnLeft" />, texts.turnLeft, turn(-step.deg)],
    ["↑", texts.up, (hand) => translateOverlay(hand, [0, -step.px])],
    [<Icon key="right" name="turnRight" />, texts.turnRight, turn(step.deg)],
    ["←", texts.left, (hand) => translateOverlay(hand, [-step.px, 0])],
    ["↓", texts.down, (hand) => translateOverlay(hand, [0, step.px])],
    ["→", texts.right, (hand) => translateOverlay(hand, [step.px, 0])],
    ["−", texts.smaller, grow(1 / step.ratio)],
    ["+", texts.larger, grow(step.ratio)],
  ];
  const { hand } = state;
  return (
    <section className="card overlay-panel">
      <p>{texts.hint}</p>
      <label className="fade">
        <span>
          {texts.fade} {formatNumber(100 * (hand?.fade_ratio ?? 0.5), 0)} %
        </span>
        <Slider
          size="xl"
          thumbSize={48}
          min={0}
          max={100}
          label={null}
          thumbLabel={texts.fade}
          data-testid="fade"
          value={100 * (hand?.fade_ratio ?? 0.5)}
          disabled={hand === null}
          onChange={(percent) => {
            controller.change((now) => fadeOverlay(now, percent / 100));
          }}
        />
      </label>
      <div className="pad" role="group" aria-label={texts.pad}>
        {pad.map(([symbol, name, next]) => (
          <Button
            key={name}
            size="lg"
            variant="default"
            aria-label={name}
            disabled={hand === null}
            onClick={() => {
              controller.step(next);
            }}
          >
            {symbol}
          </Button>
        ))}
      </div>
      <SegmentedControl
        size="md"
        aria-label={texts.step}
        value={size}
        onChange={(value) => {
          setSize(value === "fine" ? "fine" : "coarse");
        }}
        data={[
          { value: "fine", label: texts.fine },
          { value: "coarse", label: texts.coarse },
        ]}
      />
      <div className="row">
        <Button
          size="lg"
          variant="default"
          disabled={!state.canUndo}
          data-testid="overlay-undo"
          onClick={() => {
            controller.undo();
          }}
        >
          <Icon name="undo" /> {texts.undo}
        </Button>
        <Button
          size="lg"
          variant="default"
          data-testid="overlay-reset"
          onClick={() => {
            controller.reset();
          }}
        >
          {texts.reset}
        </Button>
      </div>
      <p
        data-testid="overlay-state"
        data-settled={state.settled}
        data-overlay={JSON.stringify(hand)}
        className={state.settled ? "good" : "quiet"}
      >
        {state.settled ? `✓ ${texts.exact}` : `● ${texts.following}`}
      </p>
      <p className="warning">▲ {texts.blind}</p>
      <ConcludeNeedles
        order={order}
        overlay={hand}
        isFrozen={isFrozen}
        disabled={!state.settled}
        onRelease={onRelease}
      >
        {texts.conclude}
      </ConcludeNeedles>
    </section>
  );
}
