// Why there is no picture, no number, no marker.
import type { Words } from "../shape";

export const reasonsEn: Pick<Words, "cause" | "absent" | "unseen"> = {
  cause: {
    hidden: { state: "PAGE WAS HIDDEN", sentence: "It shows again what is live as soon as it is in view." },
    connecting: { state: "CONNECTING", sentence: "Waiting for the first word from the server." },
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
    "no-image": { state: "WAITING", sentence: "No image has come yet." },
    old: { state: "TOO OLD", sentence: "What came last is too old to be shown." },
  },
  absent: {
    MARKER_UNSEEN: { state: "MARKER NOT SEEN", sentence: "Bring the marker into view of the camera." },
    CAMERA_NOT_CALIBRATED: {
      state: "CAMERA NOT CALIBRATED",
      sentence: "Start with a camera file (--camera): without it no millimetres are known.",
    },
    POSE_UNCERTAIN: { state: "POSE UNCERTAIN", sentence: "Show the marker nearer, steadier, more tilted." },
    TOOL_NOT_DEFINED: {
      state: "TOOL NOT DEFINED",
      sentence: "Say in config.yaml (tools) where the drill's tip is behind its marker.",
    },
    NOT_REGISTERED: {
      state: "NOT REGISTERED",
      sentence: "Plan and patient do not know each other: register them.",
    },
    NO_PLAN: {
      state: "NO PLAN",
      sentence: "There is no planned channel: plan one on the CT.",
    },
    REFERENCE_UNSEEN: {
      state: "PATIENT NOT SEEN",
      sentence: "The marker on the patient is not seen. Clear its view, or wipe it.",
    },
    CAMERA_MOVED: {
      state: "CAMERA MOVED",
      sentence: "The camera stands elsewhere than when plan and patient were registered. Register again.",
    },
    REFERENCE_MOVED: {
      state: "PATIENT MOVED",
      sentence: "The patient moved, or the marker on the patient. Check on a landmark, or register again.",
    },
    POSE_JUMPED: {
      state: "POSE JUMPED",
      sentence: "The drill seems to have moved farther than a hand can. Hold it still for a moment.",
    },
    NOT_CHECKED: {
      state: "NOT CHECKED",
      sentence: "Registered, but not yet held against a landmark. Touch one to check.",
    },
    NOT_CONFIRMED: {
      state: "NAVIGATION STOPPED",
      sentence: "Started again. The operator confirms that nothing has moved before it goes on.",
    },
    NOT_COSIGNED: {
      state: "NOT CO-SIGNED",
      sentence: "Plan or registration waits for the signature of a second person.",
    },
  },
  unseen: {
    NO_CANDIDATE: "nothing in the image looks like it",
    SCORE_TOO_LOW: "too few of its edges are there",
    TARGET_SCORE_TOO_LOW: "edges are there that it does not have",
    SHAPE_DIFFERS: "a look-alike: another shape inside",
  },
};
