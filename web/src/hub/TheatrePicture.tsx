import { useEffect, useState, type ReactNode } from "react";
import { useTexts } from "../texts/TextsContext";
import { formatBound } from "./heard";

const ASK_EVERY_MS = 1000;
const ASK_TIMEOUT_MS = 2000;
const AGE_HEADER = "X-Coaxial-Age-Ms";

interface Picture {
  url: string;
  capturedAtMs: number;
}

interface TheatrePictureProps {
  theatre: string;
  nowMs: number;
  staleAfterMs: number;
}

/** The small picture of a theatre with its age; nothing where it is too old. */
export function TheatrePicture({ theatre, nowMs, staleAfterMs }: TheatrePictureProps): ReactNode {
  const texts = useTexts().hub;
  const picture = usePicture(theatre);
  const ageMs = picture === null ? null : nowMs - picture.capturedAtMs;
  if (picture === null || ageMs === null || !(ageMs <= staleAfterMs)) {
    return <p className="theatre-picture soft">{texts.noPicture}</p>;
  }
  return (
    <figure className="theatre-picture">
      <img src={picture.url} alt={`${texts.picture}, ${theatre}`} />
      <figcaption className="soft">
        {texts.picture}: {texts.atMost} {formatBound(ageMs)}
      </figcaption>
    </figure>
  );
}

function usePicture(theatre: string): Picture | null {
  const [picture, setPicture] = useState<Picture | null>(null);
  useEffect(() => {
    const stop = new AbortController();
    let timer: ReturnType<typeof setTimeout> | undefined;
    let shown = "";
    const ask = async (): Promise<void> => {
      const next = document.visibilityState === "visible" ? await pictureOf(theatre, stop.signal) : null;
      if (stop.signal.aborted) return;
      URL.revokeObjectURL(shown);
      shown = next?.url ?? "";
      setPicture(next);
      timer = setTimeout(() => void ask(), ASK_EVERY_MS);
    };
    void ask();
    return () => {
      stop.abort();
      clearTimeout(timer);
      URL.revokeObjectURL(shown);
    };
  }, [theatre]);
  return picture;
}

/** The newest picture; null without a recent one. Its age counts from the question on. */
async function pictureOf(theatre: string, stop: AbortSignal): Promise<Picture | null> {
  const askedAtMs = performance.now();
  try {
    const signal = AbortSignal.any([stop, AbortSignal.timeout(ASK_TIMEOUT_MS)]);
    const answer = await fetch(`/api/theatres/${encodeURIComponent(theatre)}/picture`, { signal });
    const stated = answer.headers.get(AGE_HEADER);
    if (!answer.ok || stated === null) return null;
    return { url: URL.createObjectURL(await answer.blob()), capturedAtMs: askedAtMs - Number(stated) };
  } catch {
    return null;
  }
}
