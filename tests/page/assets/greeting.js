document.body.append("good day");
