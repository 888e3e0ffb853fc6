import { useEffect, useEffectEvent, useRef, useState } from "react";
import { useLocation } from "wouter";
import type { Picture } from "../api";
import { usePainter } from "../live/LiveContext";
import { LookReporter, viewPart, visiblePictures } from "./look";
import { useRoom } from "./RoomContext";

const REPORT_EVERY_MS = 1000;

/** Tells the room what this page shows. Draws nothing. */
export function LookReport(): null {
  const room = useRoom();
  const [path] = useLocation();
  const [reporter] = useState(() => new LookReporter());

  // Where there is no video, the figures are what is looked at.
  const hasVideo = useRef(true);

  usePainter(({ video, numbers }) => {
    const shown = hasVideo.current ? video : numbers;
    reporter.add(shown.live, shown.ageMs ?? 0);
  });

  const report = useEffectEvent(() => {
    const seat = room?.now().you?.seat;
    hasVideo.current = document.querySelector("[data-picture=video]") !== null;
    if (room === null || seat === undefined) return;
    const look = reporter.next(shownNow(path), seat);
    if (look !== null) room.send({ look });
  });
  useEffect(() => {
    const timer = setInterval(report, REPORT_EVERY_MS);
    return () => {
      clearInterval(timer);
    };
  }, []);
  return null;
}

function shownNow(path: string): Parameters<LookReporter["next"]>[0] {
  const pictures = [...document.querySelectorAll<HTMLElement>("[data-picture]")].map((one) => ({
    name: one.dataset["picture"] as Picture,
    box: one.getBoundingClientRect(),
  }));
  const layout = document.querySelector<HTMLElement>("[data-layout], [data-board-layout]")?.dataset;
  const [, view, page] = path.split("/");
  return {
    part: view === "operator" ? viewPart(page) : viewPart(layout?.["layout"] ?? layout?.["boardLayout"]),
    pictures: visiblePictures(pictures, { width: innerWidth, height: innerHeight }),
    isHidden: document.hidden,
  };
}
