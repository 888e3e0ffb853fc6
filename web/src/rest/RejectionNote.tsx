import { Alert } from "@mantine/core";
import type { ReactNode } from "react";
import { useTexts } from "../texts/TextsContext";
import type { Rejection } from "./client";

/** Shows a rejection with its remedy; renders nothing without one. */
export function RejectionNote({ rejection }: { rejection: Rejection | null }): ReactNode {
  const texts = useTexts();
  if (rejection === null) return null;
  const { message, remedy, code, language } = rejection.problem;
  const silent = message === "";
  return (
    <Alert
      className="rejection"
      role="alert"
      title={silent ? texts.rest.noAnswer : <span lang={language}>{sentence(message)}</span>}
    >
      {silent ? texts.rest.noAnswerRemedy : <span lang={language}>{remedy}</span>} <code>{code}</code>
    </Alert>
  );
}

function sentence(message: string): string {
  return message.charAt(0).toUpperCase() + message.slice(1);
}
