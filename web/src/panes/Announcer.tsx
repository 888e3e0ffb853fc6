import { useEffect, useState, type ReactNode } from "react";
import { useLive } from "../live/LiveContext";
import { useTexts } from "../texts/TextsContext";

/** A state is announced only after it has lasted this long, so that a flicker is not read out. */
const LASTS_MS = 700;

/** Announces changes of state to screen readers, never numbers. */
export function Announcer(): ReactNode {
  const texts = useTexts();
  const { video, numbers, firstMessage } = useLive().view;
  const picture = video.live ? texts.video.title : `${texts.video.none}: ${texts.cause[video.cause].state}`;
  const tracking = numbers.live ? texts.numbers.tracking : texts.numbers.none;
  const sentence = firstMessage === "awaited" ? texts.cause.connecting.sentence : `${picture}. ${tracking}.`;
  const [announcement, setAnnouncement] = useState("");
  useEffect(() => {
    const timer = setTimeout(() => {
      setAnnouncement(sentence);
    }, LASTS_MS);
    return () => {
      clearTimeout(timer);
    };
  }, [sentence]);
  return (
    <p className="heard-only" aria-live="polite" role="status">
      {announcement}
    </p>
  );
}
