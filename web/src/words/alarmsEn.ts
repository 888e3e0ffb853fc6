// The alarms in English.
import type { Words } from "./en";

export const alarmsEn: Words["alarms"] = {
  title: "Alarms",
  none: "No alarm",
  unknown: "ALARMS NOT KNOWN: the server is not heard",
  acknowledge: "Acknowledge",
  pause: "Pause sound 120 s",
  paused: "Sound paused",
  resume: "sound again",
  failed: "That did not reach the server, or could not be logged. Try again.",
  arm: "SOUND NOT ARMED: touch here",
  armFailed: "SOUND DOES NOT WORK: touch here to try again",
  armed: "Sound armed",
  over: "it is over",
  limit: "limit",
  acknowledgedBy: "acknowledged by",
  priority: { high: "HIGH", medium: "MEDIUM", low: "LOW" },
  conditions: {
    BREACH: {
      state: "BREACH",
      sentence: "The drill is through the pedicle wall",
      remedy: "Stop and draw the drill back.",
    },
    PAST_DEPTH: {
      state: "TOO DEEP",
      sentence: "The tip is past the planned end",
      remedy: "Stop and draw the drill back.",
    },
    BREACH_LIKELY: {
      state: "BREACH LIKELY",
      sentence: "Chance of being through the wall",
      remedy: "Stop, and steady the drill in full view of the camera.",
    },
    CLEARANCE_LOW: {
      state: "NEAR THE WALL",
      sentence: "Bone left beside the drill",
      remedy: "Turn the drill back towards the channel's axis.",
    },
    DRILL_UNSEEN: {
      state: "DRILL NOT SEEN",
      sentence: "Its marker is not seen",
      remedy: "Bring the marker into view; acknowledge if the drill is put away.",
    },
    REFERENCE_UNSEEN: {
      state: "PATIENT NOT SEEN",
      sentence: "The patient's marker is not seen",
      remedy: "Clear the view of the patient's marker.",
    },
    CAMERA_STALLED: {
      state: "NO IMAGE",
      sentence: "No image came",
      remedy: "Wait; look at the camera's cable.",
    },
    CAMERA_GONE: {
      state: "CAMERA GONE",
      sentence: "No images come from the camera",
      remedy: "Look at the camera and its cable; it is tried again by itself.",
    },
    POSE_UNCERTAIN: {
      state: "POSE UNCERTAIN",
      sentence: "The tip is not sure enough for this pedicle",
      remedy: "Show the marker nearer, steadier, more tilted.",
    },
    POSE_JUMPED: {
      state: "POSE UNRESOLVED",
      sentence: "Two poses explain the image, or it jumped",
      remedy: "Hold the drill still, and tilt its marker towards the camera.",
    },
    CAMERA_MOVED: {
      state: "CAMERA MOVED",
      sentence: "The camera has moved since the registration",
      remedy: "Stop, and register again.",
    },
    REFERENCE_MOVED: {
      state: "PATIENT MARKER MOVED",
      sentence: "The patient's marker has moved since the registration",
      remedy: "Stop, fix it, and register again.",
    },
    REGISTRATION_OUT_OF_DATE: {
      state: "REGISTRATION OUT OF DATE",
      sentence: "What the registration stands on was changed",
      remedy: "Stop, and register again.",
    },
    CALIBRATION_OUT_OF_DATE: {
      state: "CALIBRATION OUT OF DATE",
      sentence: "The calibration no longer holds",
      remedy: "Stop, calibrate again, then register again.",
    },
    CHECK_DUE: {
      state: "CHECK DUE",
      sentence: "Since the last check on anatomy",
      remedy: "Put the tip on a landmark that was not used, and check.",
    },
    NO_ARMED_SCREEN: {
      state: "NO SOUND",
      sentence: "No screen has its sound armed",
      remedy: "Touch the alarm band of the theatre screen once.",
    },
    DISK_NEARLY_FULL: {
      state: "DISK NEARLY FULL",
      sentence: "Room left for cases",
      remedy: "Make room on the disk.",
    },
    VIEWER_LOST: {
      state: "SCREEN LOST",
      sentence: "A screen with armed sound has gone",
      remedy: "Look whether the theatre screen still shows the page.",
    },
    RECORDING_STOPPED: {
      state: "NOT RECORDED",
      sentence: "What happens now is not written to the disk",
      remedy: "Look whether the disk is full or gone.",
    },
    HOLD_ASKED: {
      state: "HOLD ASKED",
      sentence: "A colleague asks to hold",
      remedy: "Talk to them before going on.",
    },
  },
};
