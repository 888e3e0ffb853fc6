// Joins the pure parts to the browser: WebSocket, timers, questions to the server, visibility.
import createClient from "openapi-fetch";
import type { components, paths } from "../schema";
import { chosenBefore, keepChoice } from "./chosen";
import { ViewLine, type Socket } from "./line";
import type { Live } from "./live";
import { LOOK_EVERY_MS } from "./load";
import { isSceneNote } from "./sceneAge";

export type Dashboard = components["schemas"]["DashboardMessage"];

const ASK_WHEN_QUIET_MS = 300;
const ASK_TIMEOUT_MS = 450;
const COMPARE_CLOCKS_EVERY_MS = 5000;
const NEW_LINE_WHEN_QUIET_MS = 2500;

const LOOPBACK = /^(localhost|127(\.\d+){3}|\[::1\])$/;

const server = createClient<paths>({ baseUrl: location.origin });

/** Starts everything; the answer stops it again. */
export function start(live: Live, onDashboard: (dashboard: Dashboard) => void): () => void {
  const stop = new AbortController();
  const { signal } = stop;
  const line = viewLine(live, () => void introduce(live, onDashboard, signal));
  let askedAtMs = -Infinity;
  let asking = false;

  const ask = async (): Promise<void> => {
    asking = true;
    const generation = live.currentGeneration;
    const askedNowMs = performance.now();
    const timeout = AbortSignal.any([signal, AbortSignal.timeout(ASK_TIMEOUT_MS)]);
    try {
      if (live.hasNews) {
        askedAtMs = askedNowMs;
        const { data } = await server.GET("/api/live", { signal: timeout, cache: "no-store" });
        live.answered(data ?? null, askedNowMs, generation);
      } else {
        // Before the first image there is nothing to ask for but whether anybody is there.
        await server.GET("/api/dashboard", { signal: timeout, cache: "no-store" });
        live.answered(null, askedNowMs, generation);
      }
    } catch {
      // No answer is what `quietMs` counts.
    } finally {
      asking = false;
    }
  };

  const look = (): void => {
    live.load.tick(performance.now());
    const view = live.look();
    const quietMs = live.quietMs();
    const sinceAskedMs = performance.now() - askedAtMs;
    if (view.link !== "open") return;
    if (quietMs > NEW_LINE_WHEN_QUIET_MS) {
      line.restart();
      return;
    }
    const compareClocks = live.hasNews && sinceAskedMs > COMPARE_CLOCKS_EVERY_MS;
    if (!asking && (quietMs > ASK_WHEN_QUIET_MS || compareClocks)) void ask();
  };

  const onEachScreenImage = (): void => {
    if (signal.aborted) return;
    live.load.screenImage(performance.now());
    live.look();
    requestAnimationFrame(onEachScreenImage);
  };

  const timer = setInterval(look, LOOK_EVERY_MS);
  requestAnimationFrame(onEachScreenImage);
  const onVisibility = (): void => {
    // Covered before it is hidden: the first thing seen on return must not be an old picture.
    live.setHidden(document.visibilityState === "hidden");
  };
  document.addEventListener("visibilitychange", onVisibility, { signal });
  addEventListener("pageshow", onVisibility, { signal });
  addEventListener(
    "message",
    (event) => {
      takeSceneNote(live, event);
    },
    { signal },
  );
  onVisibility();
  live.load.sharesMachine = LOOPBACK.test(location.hostname);
  live.choosePicture(chosenBefore());
  live.setOnChoice((choice) => {
    keepChoice(choice);
    line.askSize(choice);
  });
  const leaveSize = tellLargest(live, line);
  line.start();
  return () => {
    stop.abort();
    leaveSize();
    clearInterval(timer);
    line.stop();
  };
}

function viewLine(live: Live, onOpen: () => void): ViewLine {
  const line = new ViewLine({
    open: () => new WebSocket(viewAddress(live.pictureChoice)) as Socket,
    later: (action, waitMs) => {
      setTimeout(action, waitMs);
    },
    onLink: (state) => {
      live.setLink(state);
      if (state !== "open") return;
      onOpen();
      tellScenes();
    },
    onFrame: (frame) => {
      void live.take(frame).then(({ stands, showingMs }) => {
        if (stands) line.grant(showingMs);
      });
    },
  });
  return line;
}

/** Tells the server, on each line anew, when this device can show no full picture. */
function tellLargest(live: Live, line: ViewLine): () => void {
  let told = "full";
  return live.onLook(({ link, budget }) => {
    if (link !== "open") told = "full";
    else if (budget.largestPicture !== told) line.limitSize((told = budget.largestPicture));
  });
}

/** The server is there again: `watch.js` in each scene hears this, and takes its own line up at once. */
function tellScenes(): void {
  for (const frame of document.querySelectorAll<HTMLIFrameElement>("iframe[src^='/scene/']")) {
    frame.contentWindow?.postMessage({ kind: "coaxial-server" }, location.origin);
  }
}

function viewAddress(size: string): string {
  return `${location.protocol === "https:" ? "wss:" : "ws:"}//${location.host}/ws/view?size=${size}`;
}

/** Asks the server who it is and which limits hold; limits have one home, its config. */
async function introduce(
  live: Live,
  tell: (dashboard: Dashboard) => void,
  signal: AbortSignal,
): Promise<void> {
  try {
    const { data } = await server.GET("/api/dashboard", { signal, cache: "no-store" });
    if (!data) return;
    live.setLimits(data.limits);
    tell(data);
  } catch {
    // The line is gone again; the next one asks anew.
  }
}

function takeSceneNote(live: Live, event: MessageEvent<unknown>): void {
  if (event.origin !== location.origin || !isSceneNote(event.data)) return;
  live.sceneDrawn(event.data);
}
