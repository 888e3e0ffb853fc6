// Connects the pure parts to the browser: WebSockets, timers, requests, visibility.
import { type DashboardMessage, getDashboard, getLive } from "../api";
import { OPENED } from "../hub/openedTheatre";
import { Rejection } from "../rest/client";
import { storedPictureChoice, storePictureChoice } from "./storedPictureChoice";
import { MessageConnection } from "./messageConnection";
import { ViewConnection, type ViewSocket } from "./viewConnection";
import type { Live } from "./live";
import { isLoopback } from "./loopback";
import { UNLIMITED } from "./budget";
import { UPDATE_EVERY_MS } from "./load";
import type { WebSocketLike } from "./reconnectingSocket";
import { isSceneNote } from "./sceneAge";
import { SleepDetector } from "./sleepDetector";
import { socketAddress } from "./socketAddress";

export type Dashboard = DashboardMessage;

const ASK_WHEN_QUIET_MS = 300;
const ASK_TIMEOUT_MS = 450;
const ASK_AT_HUB_EVERY_MS = 1000;
const COMPARE_CLOCKS_EVERY_MS = 5000;
const NEW_LINE_WHEN_QUIET_MS = 2500;
const MEASURE_EVERY_PICTURES = 5;

/** Starts everything; the returned function stops it. */
export function start(live: Live, onDashboard: (dashboard: Dashboard) => void): () => void {
  const stop = new AbortController();
  const { signal } = stop;
  const connection = viewConnection(live, () => void introduce(live, onDashboard, signal));
  let requestedAtMs = -Infinity;
  let isRequesting = false;

  const request = async (): Promise<void> => {
    isRequesting = true;
    const generation = live.currentGeneration;
    const requestedNowMs = performance.now();
    const timeout = AbortSignal.any([signal, AbortSignal.timeout(ASK_TIMEOUT_MS)]);
    try {
      // The hub answers for itself; only a recent message of the theatre is a sign of the theatre.
      if (live.hasMessage || OPENED !== null) {
        requestedAtMs = requestedNowMs;
        live.receiveAnswer(await getLive({ signal: timeout }), requestedNowMs, generation);
      } else {
        // Before the first image the only question is whether the server answers.
        await getDashboard({ signal: timeout });
        live.receiveAnswer(null, requestedNowMs, generation);
      }
    } catch (error) {
      // A rejection is an answer too; a missing one is measured by `quietMs`.
      const isAnswer = OPENED === null && error instanceof Rejection && error.status !== null;
      if (isAnswer) live.receiveAnswer(null, requestedNowMs, generation);
    } finally {
      isRequesting = false;
    }
  };

  const sleep = new SleepDetector(Date.now, () => performance.now());

  const update = (): void => {
    // What was received before is older than its age on the page's clock, and that clock has moved away from the server's.
    if (sleep.hasSlept()) {
      connection.restart();
      messages.restart();
    }
    live.load.tick(performance.now());
    const view = live.update();
    const quietMs = live.quietMs();
    const sinceRequestMs = performance.now() - requestedAtMs;
    if (view.link !== "open") return;
    if (quietMs > NEW_LINE_WHEN_QUIET_MS) {
      connection.restart();
      return;
    }
    const compareClocks = live.hasMessage && sinceRequestMs > COMPARE_CLOCKS_EVERY_MS;
    // The hub rejects at once while the theatre is silent.
    const isSoon = OPENED !== null && sinceRequestMs < ASK_AT_HUB_EVERY_MS;
    if (!isRequesting && !isSoon && (quietMs > ASK_WHEN_QUIET_MS || compareClocks)) void request();
  };

  const timer = setInterval(update, UPDATE_EVERY_MS);
  const leaveExpiry = updateAtExpiry(live);
  const onVisibility = (): void => {
    // Covered before it is hidden, so that no old picture is visible on return.
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
  live.load.sharesMachine = isLoopback(location.hostname);
  live.choosePicture(storedPictureChoice());
  live.setOnChoice((choice) => {
    storePictureChoice(choice);
    connection.askSize(choice);
  });
  const leaveBudget = reportPictureBudget(live, connection);
  const messages = messageConnection(live);
  connection.start();
  messages.start();
  return () => {
    stop.abort();
    leaveBudget();
    leaveExpiry();
    clearInterval(timer);
    connection.stop();
    messages.stop();
  };
}

/** Messages that arrived while the page was busy are painted once, with the newest. */
function messageConnection(live: Live): MessageConnection {
  let isScheduled = false;
  return new MessageConnection({
    open: () => new WebSocket(socketAddress("/ws/live")) as WebSocketLike,
    later: (action, waitMs) => {
      setTimeout(action, waitMs);
    },
    onMessage: (message) => {
      live.receiveMessage(message);
      if (isScheduled) return;
      isScheduled = true;
      requestAnimationFrame(() => {
        isScheduled = false;
        live.update();
      });
    },
  });
}

function viewConnection(live: Live, onOpen: () => void): ViewConnection {
  let shown = 0;
  const connection = new ViewConnection({
    open: () => new WebSocket(viewAddress(live.pictureChoice)) as ViewSocket,
    later: (action, waitMs) => {
      setTimeout(action, waitMs);
    },
    onLink: (state) => {
      live.setLink(state);
      if (state !== "open") return;
      onOpen();
      notifyScenes();
    },
    onFrame: (frame) => {
      void live.receive(frame).then(({ isDisplayed, showingMs }) => {
        if (!isDisplayed) return;
        shown += 1;
        if (shown % MEASURE_EVERY_PICTURES === 0) measureScreen(live);
        connection.requestNext(showingMs);
      });
    },
  });
  return connection;
}

/**
 * Measures how long the screen takes for the image just drawn. Each measurement makes the browser compose the page
 * twice.
 */
function measureScreen(live: Live): void {
  requestAnimationFrame((beganAtMs) => {
    requestAnimationFrame((endedAtMs) => {
      live.load.screenImage(endedAtMs, endedAtMs - beganAtMs);
    });
  });
}

/** Updates exactly when figures or picture become too old, between two timer updates. */
function updateAtExpiry(live: Live): () => void {
  let timer: ReturnType<typeof setTimeout> | undefined;
  const leave = live.onUpdate(({ nowMs, expiresAtMs }) => {
    clearTimeout(timer);
    if (expiresAtMs === null || expiresAtMs - nowMs >= UPDATE_EVERY_MS) return;
    timer = setTimeout(() => live.update(), expiresAtMs - nowMs);
  });
  return () => {
    clearTimeout(timer);
    leave();
  };
}

/** Sends the rate and size that this device can display, on each connection. */
function reportPictureBudget(live: Live, connection: ViewConnection): () => void {
  let reported = UNLIMITED;
  return live.onUpdate(({ link, budget }) => {
    if (link !== "open") {
      reported = UNLIMITED;
      return;
    }
    if (budget.largestPicture !== reported.largestPicture) connection.limitSize(budget.largestPicture);
    if (budget.pictureIntervalMs !== reported.pictureIntervalMs)
      connection.limitRate(budget.pictureIntervalMs);
    reported = budget;
  });
}

/** The server has returned: `watch.js` in each scene receives this and reconnects at once. */
function notifyScenes(): void {
  for (const frame of document.querySelectorAll<HTMLIFrameElement>("iframe[src^='/scene/']")) {
    frame.contentWindow?.postMessage({ kind: "coaxial-server" }, location.origin);
  }
}

/** Figures and alarms are beside the picture and newer; the server draws none into it. */
function viewAddress(size: string): string {
  return socketAddress(`/ws/view?size=${size}&overlay=geometry`);
}

/** Requests the server's identity and limits, which are defined in its config. */
async function introduce(
  live: Live,
  onDashboard: (dashboard: Dashboard) => void,
  signal: AbortSignal,
): Promise<void> {
  try {
    const dashboard = await getDashboard({ signal });
    live.setLimits(dashboard.limits);
    onDashboard(dashboard);
  } catch {
    // Rejected, or the connection was lost again; the next one requests anew.
  }
}

function takeSceneNote(live: Live, event: MessageEvent<unknown>): void {
  if (event.origin !== location.origin || !isSceneNote(event.data)) return;
  live.sceneDrawn(event.data);
}
