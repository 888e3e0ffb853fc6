import { Alert } from "@mantine/core";
import type { ReactNode } from "react";
import { Link } from "wouter";
import { useLive } from "../../live/LiveContext";
import { useTexts } from "../../texts/TextsContext";

/** Camera or patient moved: consequence and remedy. */
export function MovementWarning(): ReactNode {
  const texts = useTexts().navigate;
  const watched = useLive().view.newest?.snapshot?.motion;
  if (!watched) return null;
  const moves = [
    { key: "camera", is: watched.camera_moved, texts: texts.cameraMoved, href: "/operator/register" },
    { key: "reference", is: watched.reference_moved, texts: texts.referenceMoved, href: "/operator/check" },
  ].filter((one) => one.is);
  return moves.map((one) => (
    <Alert
      key={one.key}
      className="rejection"
      role="alert"
      title={one.texts.title}
      data-testid={`moved-${one.key}`}
    >
      {one.texts.remedy}{" "}
      <Link className="big-link" href={one.href}>
        {one.texts.go}
      </Link>
    </Alert>
  ));
}
