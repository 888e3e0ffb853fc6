import { Alert } from "@mantine/core";
import type { ReactNode } from "react";
import { Drawing } from "../panes/Drawing";
import { useTexts } from "../texts/TextsContext";
import type { Rejection } from "./client";
import { RemedyLink } from "./RemedyLink";

/** Shows a rejection with its remedy, and a button to the page of the remedy; renders nothing without one. */
export function RejectionNote({ rejection }: { rejection: Rejection | null }): ReactNode {
  const texts = useTexts();
  if (rejection === null) return null;
  const { message, remedy, code, language } = rejection.problem;
  const silent = message === "";
  return (
    <Alert
      className="rejection"
      role="alert"
      icon={<Drawing name={silent ? "lost" : "rejected"} />}
      title={silent ? texts.rest.noAnswer : <span lang={language}>{sentence(message)}</span>}
    >
      {silent ? texts.rest.noAnswerRemedy : <span lang={language}>{remedy}</span>} <code>{code}</code>
      <RemedyLink code={code} />
    </Alert>
  );
}

/** A message with a capital letter. */
export function sentence(message: string): string {
  return message.charAt(0).toUpperCase() + message.slice(1);
}
