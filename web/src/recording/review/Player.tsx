import { Button, Slider } from "@mantine/core";
import type { ReactNode } from "react";
import { useTexts } from "../../texts/TextsContext";
import { clockDuration } from "../recordingText";

interface PlayerProps {
  number: number;
  images: number;
  atS: number;
  isPlaying: boolean;
  onPlay: (on: boolean) => void;
  onNumber: (number: number) => void;
}

/** Playback controls and a slider over all images. */
export function Player({ number, images, atS, isPlaying, onPlay, onNumber }: PlayerProps): ReactNode {
  const own = useTexts().recording.review;
  const step = (by: number, label: string, symbol: string, testId: string): ReactNode => (
    <Button
      size="lg"
      variant="default"
      aria-label={label}
      onClick={() => {
        onNumber(number + by);
      }}
      data-testid={testId}
    >
      {symbol}
    </Button>
  );
  return (
    <div className="review-player">
      {step(-1, own.before, "◀|", "review-before")}
      <Button
        size="lg"
        className="review-play"
        data-testid="review-play"
        onClick={() => {
          onPlay(!isPlaying);
        }}
      >
        {isPlaying ? `❚❚ ${own.pause}` : `▶ ${own.play}`}
      </Button>
      {step(1, own.after, "|▶", "review-after")}
      <Slider
        className="review-scrubber"
        size="xl"
        thumbSize={48}
        min={0}
        max={Math.max(images - 1, 1)}
        label={null}
        value={number}
        thumbLabel={own.scrubber}
        thumbProps={{ "aria-valuetext": clockDuration(atS) }}
        onChange={onNumber}
      />
    </div>
  );
}
