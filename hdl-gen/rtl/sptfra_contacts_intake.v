// SPDX-License-Identifier: MIT OR Apache-2.0
// Part of the SpTFRA hardware generator.
//
// Keeps the frames that come until they are answered, and sends each on once it is there as a whole: one that is too
// short or too long as it came, so that the core says so.
//
// From the last word in to the first one out: 3 cycles, where nothing is on its way.

`default_nettype none

module sptfra_contacts_intake #(
    // Words of a frame
    parameter TAXELS = 100,
    // Frames that have a place: 2, 4, 8 or 16
    parameter BANKS = 4,
    // Derived
    parameter TAXEL_WIDTH = (TAXELS > 8) ? $clog2(TAXELS) : 3,
    parameter BANK_WIDTH = $clog2(BANKS)
) (
    input  wire clock,
    input  wire reset,
    // Frames in
    input  wire [31:0] s_tdata,
    input  wire s_tvalid,
    output wire s_tready,
    input  wire s_tlast,
    input  wire free, // the oldest frame needs its place no more
    // Frames on: each begins where none is held back
    input  wire hold,
    input  wire answered, // a frame of those
    output wire drained, // none is on its way or without an answer
    output wire [31:0] m_tdata,
    output wire m_tvalid,
    input  wire m_tready,
    output wire m_tlast,
    // A word of a frame, while none is on its way: 1 cycle, where enabled
    input  wire read_enable,
    input  wire [BANK_WIDTH+TAXEL_WIDTH-1:0] read_address,
    output wire [31:0] read_word
);

    generate
        if ((BANKS != 2) && (BANKS != 4) && (BANKS != 8) && (BANKS != 16)) begin : gen_check_banks
            sptfra_error_banks_must_be_2_4_8_or_16 invalid ();
        end
    endgenerate

    localparam COUNT_WIDTH = TAXEL_WIDTH + 1;
    localparam [31:0] TAXELS_32 = TAXELS;
    localparam [31:0] BANKS_32 = BANKS;
    localparam [COUNT_WIDTH-1:0] MOST = TAXELS_32[COUNT_WIDTH-1:0]; // the number of a word too many

    // ---- In: words beyond the frame are counted, up to one
    reg [BANK_WIDTH:0] used; // places
    reg has_place;
    reg [BANK_WIDTH-1:0] newest;
    reg [COUNT_WIDTH-1:0] count;
    reg [COUNT_WIDTH-1:0] lasts [0:BANKS-1]; // of each frame the number of its last word
    wire taken = s_tvalid && s_tready;
    wire comes = taken && s_tlast;
    wire [BANK_WIDTH:0] next_used = used + {{BANK_WIDTH{1'b0}}, comes} - {{BANK_WIDTH{1'b0}}, free};

    assign s_tready = has_place;

    always @(posedge clock) begin
        used <= next_used;
        has_place <= (next_used != BANKS_32[BANK_WIDTH:0]);
        if (taken) begin
            count <= (count == MOST) ? MOST : count + 1'b1;
        end
        if (comes) begin
            lasts[newest] <= count;
            newest <= newest + 1'b1;
            count <= {COUNT_WIDTH{1'b0}};
        end
        if (reset) begin
            used <= {(BANK_WIDTH+1){1'b0}};
            has_place <= 1'b0;
            newest <= {BANK_WIDTH{1'b0}};
            count <= {COUNT_WIDTH{1'b0}};
        end
    end

    // ---- On
    reg [BANK_WIDTH:0] waiting; // frames that are there and have not begun
    reg [BANK_WIDTH-1:0] oldest;
    reg sends; // words are read
    reg [COUNT_WIDTH-1:0] place;
    reg [COUNT_WIDTH-1:0] last_place;
    reg valid;
    reg last;
    reg [BANK_WIDTH:0] unanswered;
    wire advance = m_tready || !valid;
    wire sent = valid && m_tready && last;
    wire at_last = (place == last_place);
    wire begins = !sends && !valid && !hold && (waiting != {(BANK_WIDTH+1){1'b0}});

    assign drained = !sends && !valid && (unanswered == {(BANK_WIDTH+1){1'b0}});
    assign m_tvalid = valid;
    assign m_tlast = last;
    assign m_tdata = read_word;

    always @(posedge clock) begin
        waiting <= waiting + {{BANK_WIDTH{1'b0}}, comes} - {{BANK_WIDTH{1'b0}}, begins};
        unanswered <= unanswered + {{BANK_WIDTH{1'b0}}, sent} - {{BANK_WIDTH{1'b0}}, answered};
        if (advance) begin
            valid <= sends;
            last <= at_last;
            if (sends) begin
                place <= place + 1'b1;
                sends <= !at_last;
            end
        end
        if (sent) begin
            oldest <= oldest + 1'b1;
        end
        if (begins) begin
            sends <= 1'b1;
            place <= {COUNT_WIDTH{1'b0}};
            last_place <= lasts[oldest];
        end
        if (reset) begin
            waiting <= {(BANK_WIDTH+1){1'b0}};
            unanswered <= {(BANK_WIDTH+1){1'b0}};
            oldest <= {BANK_WIDTH{1'b0}};
            sends <= 1'b0;
            valid <= 1'b0;
        end
    end

    sptfra_ram #(
        .WIDTH         (32),
        .DEPTH         (BANKS << TAXEL_WIDTH),
        .ADDRESS_WIDTH (BANK_WIDTH + TAXEL_WIDTH)
    ) frames (
        .clock         (clock),
        .write_enable  (taken && (count != MOST)),
        .write_address ({newest, count[TAXEL_WIDTH-1:0]}),
        .write_data    (s_tdata),
        .read_enable   ((sends || valid) ? advance : read_enable),
        .read_address  ((sends || valid) ? {oldest, place[TAXEL_WIDTH-1:0]} : read_address),
        .read_data     (read_word)
    );

endmodule

`default_nettype wire
