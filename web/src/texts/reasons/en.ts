// Why there is no picture, no number, no marker.
import type { Texts } from "../catalogue";

export const reasonsEn: Pick<Texts, "cause" | "unseen"> = {
  cause: {
    hidden: { state: "PAGE WAS HIDDEN", sentence: "It shows again what is live as soon as it is in view." },
    connecting: { state: "CONNECTING", sentence: "Waiting for the server." },
    "not-reached": {
      state: "SERVER NOT REACHED",
      sentence: "Check this device's network, and that Coaxial is running. Trying again by itself.",
    },
    "server-gone": { state: "SERVER GONE", sentence: "No answer from the server. Trying again by itself." },
    "process-starting": {
      state: "STARTING",
      sentence: "Tracking is being started. This takes some seconds.",
    },
    "process-restarting": { state: "RESTARTING", sentence: "Tracking stopped and is being started again." },
    "process-given_up": { state: "TRACKING STOPPED", sentence: "Tracking failed too often. See the alert." },
    "source-opening": { state: "OPENING CAMERA", sentence: "The camera is being opened." },
    "source-reconnecting": {
      state: "CAMERA LOST",
      sentence: "No images come from the camera. Trying again by itself.",
    },
    "source-ended": { state: "END OF VIDEO", sentence: "The video has been played to its end." },
    "no-image": { state: "WAITING", sentence: "No image from the camera." },
    "no-picture": { state: "WAITING", sentence: "No picture has reached this page yet." },
    old: { state: "TOO OLD", sentence: "The newest data is too old and is not shown." },
  },
  unseen: {
    NO_CANDIDATE: "nothing in the image looks like it",
    SCORE_TOO_LOW: "too few of its edges are there",
    TARGET_SCORE_TOO_LOW: "edges are there that it does not have",
    SHAPE_DIFFERS: "a look-alike: another shape inside",
    MARKER_TWICE: "a second print of it is in view: cover or remove all but one",
  },
};
