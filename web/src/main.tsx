import "@mantine/core/styles/baseline.css";
import "@mantine/core/styles/default-css-variables.css";
import "@mantine/core/styles/global.css";
import "@mantine/core/styles/UnstyledButton.css";
import "@mantine/core/styles/CloseButton.css";
import "@mantine/core/styles/Alert.css";
import "@mantine/core/styles/Table.css";
import "@mantine/core/styles/Button.css";
import "@mantine/core/styles/Loader.css";
import "@mantine/core/styles/Progress.css";
import "@mantine/core/styles/Input.css";
import "@mantine/core/styles/InlineInput.css";
import "@mantine/core/styles/Checkbox.css";
import "@mantine/core/styles/Combobox.css";
import "@mantine/core/styles/Popover.css";
import "@mantine/core/styles/ScrollArea.css";
import "@mantine/core/styles/Slider.css";
import "@mantine/core/styles/FloatingIndicator.css";
import "@mantine/core/styles/SegmentedControl.css";
import "@mantine/core/styles/NumberInput.css";
import "@mantine/core/styles/ModalBase.css";
import "@mantine/core/styles/Modal.css";
import "@mantine/core/styles/Overlay.css";
import "@mantine/core/styles/Switch.css";
import "@mantine/core/styles/Badge.css";
import "@mantine/core/styles/Paper.css";
import "@mantine/core/styles/ActionIcon.css";
import "@mantine/core/styles/Radio.css";
import "@mantine/core/styles/Tabs.css";
import "./theme/tokens.css";
import "./theme/page.css";
import "./theme/panes.css";
import "./theme/cuts.css";
import "./theme/alarms.css";
import "./theme/shell.css";
import "./theme/signin.css";
import "./theme/help.css";
import "./theme/theatre.css";
import "./theme/layouts.css";
import "./theme/operator.css";
import "./theme/restart.css";
import "./theme/case.css";
import "./theme/calibration.css";
import "./theme/planning.css";
import "./theme/registration.css";
import "./theme/supervisor.css";
import "./theme/board.css";
import "./theme/hub.css";
import "./theme/people.css";
import "./theme/connection.css";
import "./theme/latency.css";
import "./theme/phone.css";
import "./theme/recording.css";
import "./theme/tablet.css";

import { StrictMode } from "react";
import { createRoot } from "react-dom/client";
import { App } from "./app/App";
import { SessionProvider } from "./app/session";
import "./rest/client";
import { ThemeProvider } from "./theme/ThemeContext";
import { textsFor } from "./texts/language";
import { TextsProvider } from "./texts/TextsContext";

const texts = textsFor(location.search, navigator.languages);
document.documentElement.lang = texts.language;
const root = document.getElementById("root");
if (root === null) throw new Error("index.html has no #root");

createRoot(root).render(
  <StrictMode>
    <TextsProvider value={texts}>
      <SessionProvider>
        <ThemeProvider>
          <App />
        </ThemeProvider>
      </SessionProvider>
    </TextsProvider>
  </StrictMode>,
);
