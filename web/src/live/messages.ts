// The types of all messages come from the server's schema: a field renamed there fails the build here.
import type { components } from "../schema";

type Schemas = components["schemas"];

export type LiveMessage = Schemas["LiveMessage"];
export type SnapshotMessage = Schemas["SnapshotMessage"];
export type MarkerMessage = Schemas["MarkerMessage"];
export type ToolStateMessage = Schemas["ToolStateMessage"];
export type DeviationMessage = Schemas["DeviationMessage"];
export type JudgementMessage = Schemas["JudgementMessage"];
export type AlongMessage = Schemas["AlongMessage"];
export type ClosestMessage = Schemas["ClearanceMessage"]["now"];
export type Verdict = Schemas["Verdict"];
export type Wall = Schemas["Wall"];
export type MeasuredAgainst = Schemas["MeasuredAgainst"];
export type MovesSeen = Schemas["MovesSeen"];
export type TroubleMessage = Schemas["TroubleMessage"];
export type AbsentReason = Schemas["AbsentReason"];
export type UnseenReason = Schemas["UnseenReason"];
export type SourceState = Schemas["SourceState"];
export type ProcessState = Schemas["ProcessState"];
export type AlarmsMessage = Schemas["AlarmsMessage"];
export type AlarmMessage = Schemas["AlarmMessage"];
export type Condition = Schemas["Condition"];
export type Priority = Schemas["Priority"];
export type Sound = Schemas["Sound"];
