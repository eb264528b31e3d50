"""A headless Chromium by chromedriver's protocol, with the standard library alone."""
import base64, json, pathlib, re, shutil, subprocess, tempfile, time, urllib.request

FLAGS = ["--headless=new", "--no-sandbox", "--disable-gpu", "--no-first-run", "--disable-background-networking",
         "--disable-component-update", "--disable-sync", "--disable-dev-shm-usage"]

CODES = {"Tab": "\ue004", "Enter": "\ue007", "Control": "\ue009", "Space": " ", "Right": "\ue014"}


def is_there():
    return all(shutil.which(program) for program in ("chromium", "chromedriver"))


class Browser:
    def __init__(self, width, height, dark=False):
        self.folder = tempfile.TemporaryDirectory()
        self.driver = subprocess.Popen(["chromedriver", "--port=0"], stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True)
        self.port = self._port()
        flags = FLAGS + [f"--user-data-dir={self.folder.name}", f"--window-size={width},{height}"]
        wanted = {"browserName": "chrome", "goog:loggingPrefs": {"browser": "ALL"},
                  "goog:chromeOptions": {"binary": shutil.which("chromium"), "args": flags}}
        answer = self._post("/session", {"capabilities": {"alwaysMatch": wanted}})
        self.session = "/session/" + answer["sessionId"]
        scheme = [{"name": "prefers-color-scheme", "value": "dark" if dark else "light"}]
        self.devtools("Emulation.setEmulatedMedia", {"features": scheme + [{"name": "prefers-reduced-motion", "value": "reduce"}]})
        self.devtools("Emulation.setDeviceMetricsOverride", {"width": width, "height": height, "deviceScaleFactor": 1, "mobile": width < 500})
        self.post("/timeouts", {"script": 120000, "pageLoad": 60000})

    def _port(self):
        for line in self.driver.stdout:
            found = re.search(r"successfully on port (\d+)", line)
            if found:
                return int(found[1])
        raise RuntimeError("chromedriver did not start")

    def _post(self, path, body):
        request = urllib.request.Request(f"http://127.0.0.1:{self.port}{path}", json.dumps(body).encode(), {"Content-Type": "application/json"})
        try:
            with urllib.request.urlopen(request, timeout=180) as answer:
                return json.load(answer)["value"]
        except urllib.error.HTTPError as error:
            raise RuntimeError(error.read().decode()) from None

    def post(self, path, body):
        return self._post(self.session + path, body)

    def devtools(self, command, parameters):
        return self.post("/goog/cdp/execute", {"cmd": command, "params": parameters})

    def open(self, page):
        self.post("/url", {"url": page})

    def run(self, script, *arguments):
        return self.post("/execute/sync", {"script": script, "args": list(arguments)})

    def wait_for(self, script, *arguments):
        """The value that the promise of a script comes to."""
        body = f"const done = arguments[arguments.length - 1]; (async (...args) => {{ {script} }})(...arguments)" \
               ".then((value) => done({value}), (error) => done({error: String(error.message ?? error)}));"
        answer = self.post("/execute/async", {"script": body, "args": list(arguments)})
        if "error" in answer:
            raise RuntimeError(answer["error"])
        return answer.get("value")

    def until(self, condition, limit=60):
        end = time.time() + limit
        while not self.run(f"return Boolean({condition})"):
            if time.time() > end:
                raise RuntimeError(f"waited {limit} s for {condition}")
            time.sleep(0.1)

    def console_errors(self):
        return [entry["message"] for entry in self.post("/se/log", {"type": "browser"}) if entry["level"] == "SEVERE"]

    def save_into(self, folder):
        """Downloads go to this folder, and nobody is asked."""
        self.devtools("Browser.setDownloadBehavior", {"behavior": "allow", "downloadPath": str(folder)})

    def press(self, *keys):
        """Keys of a keyboard one after the other, as WebDriver names them; Control with a letter as "Control+a"."""
        actions = []
        for key in keys:
            held = CODES["Control"] if key.startswith("Control+") else None
            key = CODES.get(key.removeprefix("Control+"), key.removeprefix("Control+"))
            actions += [{"type": "keyDown", "value": held}] if held else []
            actions += [{"type": "keyDown", "value": key}, {"type": "keyUp", "value": key}]
            actions += [{"type": "keyUp", "value": held}] if held else []
        self.post("/actions", {"actions": [{"type": "key", "id": "keyboard", "actions": actions}]})

    def screenshot(self, file):
        """The whole page, not the window alone."""
        shot = self.devtools("Page.captureScreenshot", {"format": "png", "captureBeyondViewport": True})
        pathlib.Path(file).write_bytes(base64.b64decode(shot["data"]))

    def close(self):
        try:
            urllib.request.urlopen(urllib.request.Request(f"http://127.0.0.1:{self.port}{self.session}", method="DELETE"), timeout=20)
        finally:
            self.driver.terminate()
            self.driver.wait()
            self.folder.cleanup()
