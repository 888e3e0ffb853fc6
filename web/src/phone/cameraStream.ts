// Connects the pure parts to the browser: camera, video frames, canvas, WebSocket, wake lock.
import { socketAddress } from "../live/socketAddress";
import { factsOf, requestedConstraints, withLockedFocus, type Capabilities } from "./camera";
import { frameTime, type FrameTimes } from "./frameTime";
import type { CameraFacts, FrameTime, Note, Problem, Welcome } from "./messages";
import { PhoneConnection, type PhoneSocket } from "./phoneConnection";
import { keepScreenOn } from "./wakeLock";

/** Time for the automatic focus to settle; the server waits as long for other cameras. */
const FOCUS_SETTLES_MS = 3000;
const CHECK_EVERY_MS = 500;

interface SentImage {
  images: number;
  bytes: number;
  clock: FrameTime["clock"];
}

interface Listener {
  onWelcome(welcome: Welcome): void;
  onFacts(facts: CameraFacts): void;
  onSent(sent: SentImage): void;
  onNote(note: Note | null): void;
  onWakeLock(isLocked: boolean): void;
  /** The stream has ended: the server rejected it, or the browser gave no camera. */
  onRejected(problem: Problem): void;
  onNoCamera(error: unknown): void;
}

/** Sends this device's camera, previewed in `video`, until the returned function is called. */
export function startCameraStream(video: HTMLVideoElement, listener: Listener): () => void {
  const stop = new AbortController();
  const { signal } = stop;
  let track: MediaStreamTrack | null = null;
  const connection = new PhoneConnection(pageKey(), {
    open: () => new WebSocket(socketAddress("/ws/camera")) as PhoneSocket,
    later: (action, waitMs) => {
      setTimeout(action, waitMs);
    },
    nowMs: () => performance.now(),
    onWelcome: (welcome) => {
      listener.onWelcome(welcome);
      // The camera outlives a connection, so a reconnect continues with it.
      if (track === null) void begin(welcome).catch(fail);
    },
    onNote: listener.onNote.bind(listener),
    onRejected: (problem) => {
      end();
      listener.onRejected(problem);
    },
    onLost: () => {
      listener.onNote(null);
    },
  });

  const begin = async (welcome: Welcome): Promise<void> => {
    const opened = await openCamera(video, welcome);
    track = opened;
    if (signal.aborted) {
      opened.stop();
      video.srcObject = null;
      return;
    }
    opened.addEventListener("ended", () => {
      fail(new DOMException("", "NotReadableError"));
    });
    describe();
    sendFrames(video, connection, welcome, listener, signal);
    const waitMs = welcome.focus_mm === null ? FOCUS_SETTLES_MS : 0;
    setTimeout(() => void lockFocus(opened, welcome, signal), waitMs);
  };
  const describe = (): void => {
    if (track === null || video.videoWidth === 0) return;
    const size = { width: video.videoWidth, height: video.videoHeight };
    const facts = factsOf(track.label, size, track.getSettings());
    connection.describe(facts);
    listener.onFacts(facts);
  };
  const end = (): void => {
    if (signal.aborted) return;
    stop.abort();
    clearInterval(timer);
    connection.stop();
    track?.stop();
    video.srcObject = null;
  };
  const fail = (error: unknown): void => {
    if (signal.aborted) return;
    end();
    listener.onNoCamera(error);
  };

  const timer = setInterval(() => {
    connection.checkTimeout();
    describe();
  }, CHECK_EVERY_MS);
  video.addEventListener("resize", describe, { signal });
  keepScreenOn(signal, listener.onWakeLock.bind(listener));
  connection.start();
  return end;
}

async function openCamera(video: HTMLVideoElement, welcome: Welcome): Promise<MediaStreamTrack> {
  const stream = await navigator.mediaDevices.getUserMedia({
    audio: false,
    video: requestedConstraints(welcome),
  });
  const track = stream.getVideoTracks()[0];
  if (track === undefined) throw new DOMException("", "NotFoundError");
  video.srcObject = stream;
  await video.play();
  return track;
}

async function lockFocus(track: MediaStreamTrack, welcome: Welcome, signal: AbortSignal): Promise<void> {
  // Safari and Firefox do not report these capabilities, or any.
  const capabilities = "getCapabilities" in track ? (track.getCapabilities() as Capabilities) : {};
  const constraints = withLockedFocus(welcome, capabilities, track.getSettings());
  if (constraints === null || signal.aborted) return;
  try {
    await track.applyConstraints(constraints);
  } catch {
    // The resulting settings are read back and sent.
  }
}

function sendFrames(
  video: HTMLVideoElement,
  connection: PhoneConnection,
  welcome: Welcome,
  listener: Listener,
  signal: AbortSignal,
): void {
  const canvas = document.createElement("canvas");
  const context = canvas.getContext("2d", { alpha: false });
  let encoding = false;
  let images = 0;
  const take = (times: FrameTimes): void => {
    if (encoding || !connection.isFree || context === null) return;
    const time = frameTime(times);
    if (canvas.width !== video.videoWidth || canvas.height !== video.videoHeight) {
      canvas.width = video.videoWidth;
      canvas.height = video.videoHeight;
    }
    context.drawImage(video, 0, 0);
    encoding = true;
    void jpegOf(canvas, welcome.quality_ratio).then((jpeg) => {
      encoding = false;
      if (jpeg === null || signal.aborted || !connection.send(jpeg, time)) return;
      images += 1;
      listener.onSent({ images, bytes: jpeg.byteLength, clock: time.clock });
    });
  };
  const onFrame = (_now: number, times: FrameTimes): void => {
    if (signal.aborted) return;
    video.requestVideoFrameCallback(onFrame);
    take(times);
  };
  video.requestVideoFrameCallback(onFrame);
}

async function jpegOf(canvas: HTMLCanvasElement, quality: number): Promise<ArrayBuffer | null> {
  const blob = await new Promise<Blob | null>((resolve) => {
    canvas.toBlob(resolve, "image/jpeg", quality);
  });
  return blob === null ? null : blob.arrayBuffer();
}

const KEY_NAME = "coaxial-camera";

/** Persists for the lifetime of the tab, so that a reload keeps its identity. */
function pageKey(): string {
  const known = sessionStorage.getItem(KEY_NAME);
  if (known !== null) return known;
  const key = [...crypto.getRandomValues(new Uint8Array(16))]
    .map((byte) => byte.toString(16).padStart(2, "0"))
    .join("");
  sessionStorage.setItem(KEY_NAME, key);
  return key;
}
