// SPDX-License-Identifier: MIT OR Apache-2.0
//
// Rules of AXI4-Stream for the skid buffer: what comes in goes out, once, in order, with its TLAST.
//
// A queue of two words stands beside the buffer; every word that the buffer offers is the oldest of it.
module harness (
    input wire clock,
    input wire reset,
    input wire [31:0] s_tdata,
    input wire s_tlast,
    input wire s_tvalid,
    input wire m_tready
);

    wire s_tready;
    wire [31:0] m_tdata;
    wire m_tlast;
    wire m_tvalid;
    wire spare_full;
    wire [31:0] spare_data;
    wire spare_last;

    sptfra_axis_skid subject (
        .clock      (clock),
        .reset      (reset),
        .s_tdata    (s_tdata),
        .s_tlast    (s_tlast),
        .s_tvalid   (s_tvalid),
        .s_tready   (s_tready),
        .m_tdata    (m_tdata),
        .m_tlast    (m_tlast),
        .m_tvalid   (m_tvalid),
        .m_tready   (m_tready),
        // Inside
        .spare_full (spare_full),
        .spare_data (spare_data),
        .spare_last (spare_last)
    );

    // ---- The queue: oldest word first
    reg started = 1'b0;
    reg [1:0] held;
    reg [32:0] first;
    reg [32:0] second;
    wire taken = s_tvalid && s_tready;
    wire given = m_tvalid && m_tready;
    wire [1:0] kept = held - {1'b0, given};

    always @(posedge clock) begin
        started <= 1'b1;
        held <= kept + {1'b0, taken};
        if (given) begin
            first <= second;
        end
        if (taken && (kept == 2'd0)) begin
            first <= {s_tlast, s_tdata};
        end
        if (taken && (kept == 2'd1)) begin
            second <= {s_tlast, s_tdata};
        end
        if (reset) begin
            held <= 2'd0;
        end
    end

    always @(*) begin
        if (!started) begin
            assume (reset);
        end
    end

    // ---- What was on offer in the cycle before
    reg waited = 1'b0;
    reg [32:0] waiting;

    always @(posedge clock) begin
        waited <= m_tvalid && !m_tready && !reset;
        waiting <= {m_tlast, m_tdata};
    end

    always @(posedge clock) begin
        if (started) begin
            // No word is lost, doubled or out of order
            assert (held <= 2'd2);
            assert (m_tvalid == (held != 2'd0));
            assert (!m_tvalid || ({m_tlast, m_tdata} == first));
            assert (!taken || (kept != 2'd2));
            // A word that is offered stays until it is taken
            assert (!waited || (m_tvalid && ({m_tlast, m_tdata} == waiting)));
            // Whoever waits is served: a word that is held is offered, and room is offered unless two are held
            assert (s_tready || (held == 2'd2) || after_reset);
            // Where the second word is
            assert (spare_full == (held == 2'd2));
            assert (!spare_full || ({spare_last, spare_data} == second));
            assert (!(spare_full && s_tready));
        end
    end

    reg after_reset = 1'b1;

    always @(posedge clock) begin
        after_reset <= reset;
    end

endmodule
