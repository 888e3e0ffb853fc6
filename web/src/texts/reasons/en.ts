// Reasons for a missing picture, number or marker.
import type { Texts } from "../catalogue";

export const reasonsEn: Pick<Texts, "cause" | "unseen"> = {
  cause: {
    hidden: { state: "PAGE WAS HIDDEN", sentence: "The live display resumes when the page is visible." },
    connecting: { state: "CONNECTING", sentence: "Waiting for the server." },
    "not-reached": {
      state: "SERVER NOT REACHED",
      sentence: "Check this device's network, and that Coaxial is running. Retrying automatically.",
    },
    "server-gone": { state: "SERVER LOST", sentence: "The server does not answer. Retrying automatically." },
    "process-starting": {
      state: "STARTING",
      sentence: "Tracking is starting. This takes a few seconds, at the first start a minute or two.",
    },
    "process-restarting": { state: "RESTARTING", sentence: "Tracking stopped and is restarting." },
    "process-given_up": { state: "TRACKING STOPPED", sentence: "Tracking failed too often. See the alert." },
    "source-opening": { state: "OPENING CAMERA", sentence: "The camera is being opened." },
    "source-reconnecting": {
      state: "CAMERA LOST",
      sentence: "The camera sends no images. Retrying automatically.",
    },
    "source-ended": { state: "END OF VIDEO", sentence: "The video was played to its end." },
    "no-image": { state: "WAITING", sentence: "No image from the camera." },
    "no-picture": { state: "WAITING", sentence: "No picture has reached this page yet." },
    old: { state: "TOO OLD", sentence: "The newest data is too old and is not shown." },
  },
  unseen: {
    NO_CANDIDATE: "nothing in the image looks like it",
    SCORE_TOO_LOW: "too few of its edges are visible",
    TARGET_SCORE_TOO_LOW: "edges are visible that it does not have",
    SHAPE_DIFFERS: "a similar object with another pattern",
    NOT_REPORTED: "the tracker reports no valid pose",
    MARKER_TWICE: "twice in view: cover or remove all but one",
  },
};
