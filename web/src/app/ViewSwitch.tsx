import type { ReactNode } from "react";
import { Link, useLocation } from "wouter";
import { useTexts } from "../texts/TextsContext";
import { useSession } from "./session";
import { PATHS, viewAt, viewsOf } from "./views";

/** Views that this role may open; nothing if there is only one. */
export function ViewSwitch(): ReactNode {
  const texts = useTexts().shell;
  const { session } = useSession();
  const [path] = useLocation();
  if (session.state !== "in") return null;
  const views = viewsOf(session.who.role);
  if (views.length < 2) return null;
  const now = viewAt(path, session.who.role);
  return (
    <nav className="views" aria-label={texts.views}>
      {views.map((view) => (
        <Link key={view} href={PATHS[view]} aria-current={view === now ? "page" : undefined}>
          {texts.view[view]}
        </Link>
      ))}
    </nav>
  );
}
