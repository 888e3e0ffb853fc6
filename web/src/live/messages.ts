// Types of all messages, from the server's schema: a renamed field fails the build.
import type { components } from "../schema";

type Schemas = components["schemas"];

export type LiveMessage = Schemas["LiveMessage"];
export type SnapshotMessage = Schemas["SnapshotMessage"];
export type MarkerMessage = Schemas["MarkerMessage"];
export type DeviationMessage = Schemas["DeviationMessage"];
export type JudgementMessage = Schemas["JudgementMessage"];
export type AssessmentMessage = Schemas["AssessmentMessage"];
export type FigureMessage = Schemas["FigureMessage"];
export type HeadlineMessage = Schemas["HeadlineMessage"];
export type TextMessage = Schemas["TextMessage"];
export type Status = Schemas["Status"];
export type Tone = Schemas["Tone"];
export type ChannelMessage = Schemas["ChannelMessage"];
export type BullseyeMessage = Schemas["BullseyeMessage"];
export type Wall = Schemas["Wall"];
export type MotionDetection = Schemas["MotionDetection"];
export type LiveProblemMessage = Schemas["LiveProblemMessage"];
export type UnseenReason = Schemas["UnseenReason"];
export type CameraModeMessage = Schemas["CameraModeMessage"];
export type CameraNoteMessage = Schemas["CameraNoteMessage"];
export type CameraStatusMessage = Schemas["CameraStatusMessage"];
export type ImageClock = Schemas["ImageClock"];
export type AlarmsMessage = Schemas["AlarmsMessage"];
export type AlarmMessage = Schemas["AlarmMessage"];
export type Priority = Schemas["Priority"];
export type Sound = Schemas["Sound"];
