import type { ReactNode } from "react";
import { useLive } from "../live/LiveContext";
import { shownNumber } from "../live/rounding";
import { useWords } from "../words/WordsContext";
import { searchTimeMs } from "./searchTime";

type Mood = "good" | "waiting" | "bad" | "plain";
const SYMBOL: Record<Mood, string> = { good: "●", waiting: "◌", bad: "▲▲", plain: "" };

interface FactProps {
  name: string;
  value: string;
  mood?: Mood;
  testid?: string;
}

function Fact({ name, value, mood = "plain", testid }: FactProps): ReactNode {
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

/** Who this is, what it is connected to, and that it is no medical device. */
export function Header(): ReactNode {
  const words = useWords();
  const { view, dashboard } = useLive();
  const { newest, video, link } = view;
  const gone = link === "open" && !video.live && video.cause === "server-gone";
  const linkState = gone ? "lost" : link;
  const snapshot = linkState === "open" ? (newest?.snapshot ?? null) : null;
  const source = linkState === "open" ? (newest?.source ?? null) : null;
  const cameraState = source?.state ?? "unknown";
  const searchMs = snapshot === null ? null : searchTimeMs(snapshot.stage_ms);
  const h = words.header;
  const registered =
    snapshot?.registered_by == null ? h.noRegistration : `${h.registeredBy} ${snapshot.registered_by}`;
  return (
    <header className="top">
      <div className="brand">
        <img src="/coaxial.svg" alt="" width={44} height={44} />
        <div>
          <h1>{dashboard?.product ?? words.product}</h1>
          <p className="notice">{words.notice}</p>
        </div>
      </div>
      <dl className="facts">
        <Fact name={h.case} value={snapshot ? `${snapshot.channel_name ?? "—"} · ${registered}` : "—"} />
        <Fact name={h.source} value={source?.name ?? "—"} testid="source" />
        <Fact name={h.rate} value={source ? `${shownNumber(source.rate_hz, 0)} /s` : "—"} />
        <Fact
          name={h.searchTime}
          value={searchMs === null ? "—" : `${shownNumber(searchMs)} ms`}
          testid="search-time"
        />
        <Fact
          name={h.camera}
          value={words.cameraState[cameraState]}
          mood={cameraState === "running" ? "good" : cameraState === "opening" ? "waiting" : "bad"}
          testid="camera-state"
        />
        <Fact
          name={h.server}
          value={words.linkState[linkState]}
          mood={linkState === "open" ? "good" : linkState === "connecting" ? "waiting" : "bad"}
          testid="link-state"
        />
      </dl>
    </header>
  );
}
